#include "post/strength.hpp"

#include <algorithm>
#include <cmath>

#include "wording.hpp"

namespace mortise::post {

namespace {

constexpr double strength = 0.01;           // of Young's modulus
constexpr double with_rounding = 1 + 1e-6;  // a pressure of just that is none too large
constexpr double large_error = 0.25;
constexpr double large_push = 1e-3;

}  // namespace

std::vector<Warning> large_pressures(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
                                     const std::vector<double>& softest, const std::vector<std::string>& bodies,
                                     const Communicator& comm)
{
  // Of each contact the bodies on its sides, on every rank.
  std::vector<std::pair<int, int>> sides;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    for (const int b : pairs[c].secondary.body) sides.emplace_back(static_cast<int>(c), b);
    if (pairs[c].primary)
      for (const int b : pairs[c].primary->body) sides.emplace_back(static_cast<int>(c), b);
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  struct Side {
    int contact, body;
  };
  std::vector<Side> mine;
  for (const auto& [contact, body] : sides) mine.push_back({contact, body});
  std::vector<double> modulus(pairs.size(), std::numeric_limits<double>::infinity());
  std::vector<int> soft(pairs.size(), -1);
  for (const auto& side : comm.all_gather(mine)) {
    const double e = softest[static_cast<std::size_t>(side.body)];
    auto& least = modulus[static_cast<std::size_t>(side.contact)];
    auto& which = soft[static_cast<std::size_t>(side.contact)];
    if (e > least || (e == least && which >= 0 && which <= side.body)) continue;
    least = e;
    which = side.body;
  }
  std::vector<Found> peaks(pairs.size());
  for (std::size_t c = 0; c < pairs.size(); ++c)
    for (std::size_t i = 0; i < surfaces[c].recovered_pressure.size(); ++i)
      peaks[c].take(surfaces[c].recovered_pressure[i], pairs[c].secondary.points[i]);
  peaks = largest_of_ranks(peaks, comm);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const double limit = strength * modulus[c];
    if (soft[c] < 0 || !(peaks[c].value > with_rounding * limit)) continue;
    const auto& body = bodies[static_cast<std::size_t>(soft[c])];
    Warning w{
        "large_pressure",
        fmt::format("contact {} presses with {:.4g} at {}, {:.2g} of Young's modulus {:.4g} of body \"{}\": beyond what linear "
                    "elasticity describes",
                    pairs[c].options.name, peaks[c].value, spell(peaks[c].at), peaks[c].value / modulus[c], modulus[c], body),
        "look at units, gaps and overlaps; sharp edges press without bound as the mesh is refined: round them"};
    w.at = peaks[c].at;
    w.body = body;
    w.boundary = pairs[c].options.secondary;
    w.contact = pairs[c].options.name;
    w.value = peaks[c].value;
    w.limit = limit;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "contacts");
}

std::vector<double> largest_tensions(std::span<const contact::ContactNodeState> points, std::size_t contacts,
                                     const Communicator& comm)
{
  std::vector<double> result(contacts, 0.0);
  for (const auto& p : points) {
    auto& largest = result[static_cast<std::size_t>(p.contact)];
    if (p.status != contact::Status::open && p.area > 0) largest = std::max(largest, -p.force / p.area);
  }
  for (auto& tension : result) tension = comm.max(tension);
  return result;
}

std::vector<Warning> strained_supports(const std::vector<SupportLoad>& supports, double forces)
{
  std::vector<Warning> result;
  for (const auto& s : supports) {
    const double force = std::hypot(s.force[0], s.force[1], s.force[2]);
    const double limit = strength * s.young_modulus;
    if (!(force > 1e-6 * forces) || force <= with_rounding * limit * s.area) continue;
    const double stress = s.area > 0 ? force / s.area : std::numeric_limits<double>::infinity();
    Warning w{
        "strained_support",
        fmt::format("support \"{}\" at {} carries {:.4g} on an area of {:.3g}: {:.3g} on the average, {:.2g} of Young's modulus "
                    "{:.4g}",
                    s.boundary, spell(s.centre), force, s.area, stress, stress / s.young_modulus, s.young_modulus),
        "support a face of the real seat's size; if it only stops a rigid motion, look for what drives that motion"};
    w.at = s.centre;
    w.boundary = s.boundary;
    w.value = stress;
    w.limit = limit;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "supports");
}

std::vector<Warning> point_forces(const std::vector<PointForce>& found, double forces)
{
  std::vector<Warning> result;
  const double limit = 1e-3 * forces;
  for (const auto& f : found) {
    if (!(f.force > limit)) continue;
    Warning w{"point_force",
              fmt::format("{} acts with {:.4g} on nodes alone: stresses and displacements there have no limit as the mesh is "
                          "refined",
                          f.name, f.force),
              "read them some cells away, or let it act on a boundary or through a coupling"};
    w.value = f.force;
    w.limit = limit;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "loads, supports and springs");
}

std::vector<Warning> coarse_mesh(const MeshError& error, const std::vector<std::string>& bodies)
{
  if (!(error.relative > large_error)) return {};
  std::size_t most = 0;
  for (std::size_t b = 1; b < error.cells.size(); ++b)
    if (error.cells[b].value > error.cells[most].value) most = b;
  Warning w{"coarse_mesh",
            fmt::format(
                "the mesh's error is about {:.2g} % in the energy norm, largest in body \"{}\" at {}, which has {:.2g} % of its "
                "square: stresses may be off by as much and more",
                100 * error.relative, bodies[most], spell(error.cells[most].at), 100 * error.part[most]),
            "make the cells smaller there, or take cells of second order"};
  w.at = error.cells[most].at;
  w.body = bodies[most];
  w.value = error.relative;
  w.limit = large_error;
  return {w};
}

std::vector<Warning> facet_push(double part, const Point& force)
{
  if (!(part > large_push)) return {};
  Warning w{
      "facet_push",
      fmt::format("facets of the mesh push with {:.3g}, {:.2g} % of the largest force, along a motion that nothing resists; held "
                  "against it by {}",
                  force.norm(), 100 * part, spell(force)),
      "a finer mesh, or cells of second order, push less; or hold the body against this motion by a support"};
  w.value = part;
  w.limit = large_push;
  return {w};
}

}  // namespace mortise::post
