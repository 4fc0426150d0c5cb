#include "post/strength.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pressed_faces.hpp"
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
  std::vector<double> modulus(pairs.size(), std::numeric_limits<double>::infinity());
  std::vector<int> soft(pairs.size(), -1);
  const auto sides = bodies_of_contacts(pairs, comm);
  for (std::size_t c = 0; c < pairs.size(); ++c)
    for (const int body : sides[c])
      if (const double e = softest[static_cast<std::size_t>(body)]; e < modulus[c]) modulus[c] = e, soft[c] = body;
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

namespace {

constexpr double bent = 0.83;  // of the largest pressure: what a mean over faces may lose

// How many faces a patch is wide, 0 for less than one; 3 where that is enough, or does not matter.
int narrow_width(const PressedPatch& p)
{
  constexpr double most = 0.5;
  const int wide = p.whole == 0 || p.between > most * p.force ? 0 : p.inside == 0 ? 1 : p.core == 0 ? 2 : 3;
  // One face of first order has next to the same pressure at all its nodes, whatever is right.
  const bool told_by_mean = wide == 2 || (wide == 1 && p.second_order > 0);
  return told_by_mean && p.recovered.value > bent * p.node.value ? 3 : wide;
}

// Of each contact the patch that is too narrow by most, of those that matter beside its others; null where none is.
std::vector<const PressedPatch*> narrowest(const std::vector<PressedPatch>& patches, std::size_t contacts, double nothing)
{
  constexpr double of_force = 0.2, of_pressure = 0.3;
  std::vector<const PressedPatch*> result(contacts, nullptr);
  std::vector<double> forces(contacts, 0.0), pressures(contacts, 0.0);
  for (const auto& p : patches) {
    const auto c = static_cast<std::size_t>(p.contact);
    forces[c] = std::max(forces[c], p.force);
    pressures[c] = std::max(pressures[c], p.node.value);
  }
  for (const auto& p : patches) {
    const auto c = static_cast<std::size_t>(p.contact);
    if (!(p.node.value > 0) || p.force < std::max(of_force * forces[c], nothing) || p.node.value < of_pressure * pressures[c])
      continue;
    const int wide = narrow_width(p), before = result[c] ? narrow_width(*result[c]) : 3;
    if (wide < before || (wide < 3 && wide == before && p.node.value > result[c]->node.value)) result[c] = &p;
  }
  return result;
}

}  // namespace

std::vector<Warning> narrow_contacts(std::span<const contact::SurfaceState> surfaces,
                                     std::span<const contact::ContactNodeState> states, std::span<const contact::Pair> pairs,
                                     double nothing, const Communicator& comm)
{
  const auto patches = pressed_patches(surfaces, states, pairs, comm);
  const auto found = narrowest(patches, pairs.size(), nothing);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (!found[c]) continue;
    const auto &peak = found[c]->node, &recovered = found[c]->recovered;
    const int wide = narrow_width(*found[c]);
    const auto& name = pairs[c].options.name;
    Warning w{
        "narrow_contact",
        wide == 0
            ? fmt::format(
                  "contact {} presses at {}, but on no whole face of its secondary side: it is narrower than a face, and its "
                  "area, its pressure and how far the bodies approach are those of the mesh; the error that is given for the "
                  "mesh leaves this out and may be far too small",
                  name, spell(peak.at))
            : fmt::format(
                  "contact {} presses at {} on about {} of its secondary side across: that is too narrow for its pressure, "
                  "{:.4g} as a mean over faces and {:.4g} at one node; this, its area and how far the bodies approach are "
                  "those of the mesh, and the error that is given for the mesh leaves it out",
                  name, spell(peak.at), wide == 1 ? "one face" : "two faces", recovered.value, peak.value),
        wide == 0 && !pairs[c].options.exchanged
            ? "make the faces there smaller, those of the other side as well; or let the side with the smaller faces be secondary"
            : "make the faces there smaller, on both sides, until four and more press across"};
    w.at = peak.at;
    w.boundary = pairs[c].options.secondary;
    w.contact = name;
    w.value = wide;
    w.limit = wide + 1;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "contacts", [](const Warning& w) { return -w.value; });
}

namespace {

// The faces of one side of a contact.
struct Faces {
  double count = 0, size = 0;  // `size`: the sum of the longest distances from their first corners
  double modulus = std::numeric_limits<double>::infinity();

  void take(const mesh::Surface& side, const std::vector<double>& softest)
  {
    for (std::size_t f = 0; f < side.faces.size(); ++f) {
      const auto corners = side.faces[f].first(static_cast<std::size_t>(mesh::corner_count(side.faces.type[f])));
      const auto at = [&](Local n) { return side.points[static_cast<std::size_t>(n)]; };
      double longest = 0;
      for (const Local n : corners) longest = std::max(longest, (at(n) - at(corners[0])).norm());
      size += longest;
      ++count;
      modulus = std::min(modulus, softest[static_cast<std::size_t>(side.body[f])]);
    }
  }
  void take(const Faces& others)
  {
    count += others.count, size += others.size;
    modulus = std::min(modulus, others.modulus);
  }
};

struct FacesInContact {
  Faces secondary, primary;
  double whole = 0, partly = 0;  // secondary faces that are pressed at all corners, at some
};

}  // namespace

std::vector<Warning> scattered_contacts(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
                                        const std::vector<double>& softest, const Communicator& comm)
{
  constexpr double stiffer = 4, finer = 1.2, twice = 2, least = 8;
  std::vector<FacesInContact> mine(pairs.size());
  std::vector<Found> peaks(pairs.size());
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& side = pairs[c].secondary;
    if (!pairs[c].primary || pairs[c].options.law == contact::Law::bonded) continue;
    mine[c].secondary.take(side, softest);
    mine[c].primary.take(*pairs[c].primary, softest);
    for (std::size_t i = 0; i < surfaces[c].pressure.size(); ++i) peaks[c].take(surfaces[c].pressure[i], side.points[i]);
    for (std::size_t f = 0; f < side.faces.size(); ++f) {
      const auto [count, corners] = pressed_corners(side, surfaces[c], f);
      (count == corners ? mine[c].whole : mine[c].partly) += count > 0;
    }
  }
  peaks = largest_of_ranks(peaks, comm);
  const auto all = comm.all_gather(mine);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    FacesInContact sum;
    for (std::size_t r = c; r < all.size(); r += pairs.size()) {
      sum.secondary.take(all[r].secondary), sum.primary.take(all[r].primary);
      sum.whole += all[r].whole, sum.partly += all[r].partly;
    }
    const auto& [secondary, primary, whole, partly] = sum;
    if (!(secondary.modulus > stiffer * primary.modulus) ||
        !(secondary.size * finer * primary.count < primary.size * secondary.count) || partly < least || partly <= twice * whole)
      continue;
    Warning w{
        "scattered_contact",
        fmt::format("contact {} presses at single points, most at {}: its secondary side is the stiffer one, {:.2g} times, and "
                    "has the smaller faces, and those of the soft side do not follow it between their nodes: pressures are too "
                    "large by as much as the contact's area is too small, forces are right",
                    pairs[c].options.name, spell(peaks[c].at), secondary.modulus / primary.modulus),
        "let the softer side be secondary, or give it faces as small as those of the other side"};
    w.at = peaks[c].at;
    w.boundary = pairs[c].options.secondary;
    w.contact = pairs[c].options.name;
    w.value = partly;
    w.limit = twice * whole;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "contacts");
}

std::vector<double> largest_tensions(std::span<const contact::ContactNodeState> states, std::size_t contacts,
                                     const Communicator& comm)
{
  std::vector<double> result(contacts, 0.0);
  for (const auto& p : states) {
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
                "the mesh's error is about {:.2g} % in the energy norm, largest in body \"{}\" at {}, which has {:.0f} % of its "
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

std::vector<Warning> unresisted_loads(std::span<const feti::UnresistedLoad> found, const std::vector<std::string>& bodies)
{
  std::vector<Warning> result;
  for (const auto& load : found) {
    const auto& body = bodies[static_cast<std::size_t>(load.body)];
    Warning w{
        "unresisted_load",
        fmt::format("body \"{}\" {}, driven by {} of {:.3g}, {:.2g} % of what its loads come to, and {}: the solution leaves "
                    "this motion out",
                    body, load.motion, load.turns ? "a moment" : "a force", load.force, 100 * load.part,
                    load.of_facets ? "facets of the mesh are no support against it" : "nothing resists it"),
        load.turns ? "hold the body against it by a support or friction; a load that should pass through the axis of a "
                     "coarsely meshed surface does so on a finer mesh"
                   : "hold the body against it by a support or friction, or take this part out of the loads"};
    w.body = body;
    w.value = load.part;
    w.limit = load.limit;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "motions", [](const Warning& w) { return w.value; });
}

}  // namespace mortise::post
