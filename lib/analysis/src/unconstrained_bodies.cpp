#include <fmt/format.h>

#include <algorithm>

#include "analysis/checks.hpp"
#include "base/error.hpp"
#include "contact/proximity.hpp"
#include "nodes_in_rows.hpp"

namespace mortise::analysis {

namespace {

// Resultants smaller than this part of the forces on a body are rounding.
constexpr double no_force = 1e-6;

// For each body whether a contact row speaks of one of its nodes. Nodes and bodies meet on rank node % ranks. Collective.
std::vector<bool> reached(const std::vector<contact::Pair>& pairs, const constraint::Contacts& contacts, std::size_t bodies,
                          const Communicator& comm)
{
  struct NodeOfBody {
    Global node;
    long long body;
    auto operator<=>(const NodeOfBody&) const = default;
  };
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<NodeOfBody>> on_bodies(ranks);
  std::vector<std::vector<Global>> touched(ranks);
  const auto tell = [&](const mesh::Surface& surface) {
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
      for (const Local n : surface.faces[f]) {
        const Global node = surface.node_id[static_cast<std::size_t>(n)];
        on_bodies[static_cast<std::size_t>(node) % ranks].push_back({node, surface.body[f]});
      }
  };
  for (const auto& pair : pairs) {
    tell(pair.secondary);
    if (pair.primary) tell(*pair.primary);
  }
  for (auto& nodes : on_bodies) {
    std::ranges::sort(nodes);
    nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  }
  for (const Global node : nodes_in_rows(contacts)) touched[static_cast<std::size_t>(node) % ranks].push_back(node);
  std::vector<Global> nodes;
  for (const auto& part : comm.exchange(touched)) nodes.insert(nodes.end(), part.begin(), part.end());
  std::sort(nodes.begin(), nodes.end());
  std::vector<double> found(bodies, 0.0);
  for (const auto& part : comm.exchange(on_bodies))
    for (const auto& place : part)
      if (std::binary_search(nodes.begin(), nodes.end(), place.node)) found[static_cast<std::size_t>(place.body)] = 1;
  comm.sum_in_place(found);
  std::vector<bool> result;
  for (const double f : found) result.push_back(f > 0);
  return result;
}

// For each body whether its loads have a resultant or a moment that moves it. Collective.
std::vector<bool> driven(const model::Model& model, const model::LoadState& state, const Communicator& comm)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  const auto load = model.loads(state, comm);
  const auto frames = feti::body_frames(decomposition, comm);
  const int dimension = deck.dimension();
  std::vector<double> sums(frames.size() * 7, 0.0);  // force, moment about the centre over the radius, sum of |force|
  for (std::size_t s = 0; s < load.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& frame = frames[static_cast<std::size_t>(subdomain.body)];
    double* sum = &sums[static_cast<std::size_t>(subdomain.body) * 7];
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n) {
      Point force = Point::Zero();
      force.head(dimension) = load[s].segment(static_cast<Eigen::Index>(n) * dimension, dimension);
      const Point moment = (subdomain.mesh.points[n] - frame.centre).cross(force) / frame.radius;
      sum[6] += force.norm();
      for (int c = 0; c < 3; ++c) {  // a ring moves along its axis alone
        if (!deck.axisymmetric() || c == 1) sum[c] += force[c];
        if (!deck.axisymmetric()) sum[3 + c] += moment[c];
      }
    }
  }
  comm.sum_in_place(sums);
  std::vector<bool> result;
  for (std::size_t b = 0; b < frames.size(); ++b) {
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> resultant(&sums[b * 7]);
    result.push_back(resultant.norm() > no_force * sums[b * 7 + 6]);
  }
  return result;
}

// The contacts that name a body, and how far they look. Collective.
std::vector<std::string> searches(const std::vector<contact::Pair>& pairs, std::size_t bodies, const Communicator& comm)
{
  const auto reach = contact::search_distances(pairs, comm);
  std::vector<double> names(pairs.size() * bodies, 0.0);
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    for (const int body : pairs[c].secondary.body) names[c * bodies + static_cast<std::size_t>(body)] = 1;
    if (pairs[c].primary)
      for (const int body : pairs[c].primary->body) names[c * bodies + static_cast<std::size_t>(body)] = 1;
  }
  comm.sum_in_place(names);
  std::vector<std::string> result(bodies, "no contact names it");
  std::vector<double> widest(bodies, 0.0);
  for (std::size_t b = 0; b < bodies; ++b)
    for (std::size_t c = 0; c < pairs.size(); ++c)
      if (names[c * bodies + b] > 0 && reach[c] > widest[b]) {
        widest[b] = reach[c];
        result[b] = fmt::format("search_distance is {:.4g} (contact {})", reach[c], pairs[c].options.name);
      }
  return result;
}

}  // namespace

void check_unconstrained_bodies(const model::Model& model, const Rows& rows, const Context& context, Warnings& warnings)
{
  const auto& comm = context.comm;
  const auto& decomposition = model.decomposition();
  const auto& bodies = decomposition.catalogue.bodies;
  std::vector<bool> alone = model.supported(reached(rows.pairs, rows.constraints.contacts, bodies.size(), comm), comm);
  alone.flip();
  if (std::none_of(alone.begin(), alone.end(), [](bool b) { return b; })) return;

  const auto nearest = contact::nearest_bodies(model.outer_surface(comm), alone, comm);
  const auto moving = driven(model, rows.acts, comm);
  const auto why = searches(rows.pairs, bodies.size(), comm);
  std::string loaded;
  int told = 0;
  constexpr int most = 10;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!alone[b]) continue;
    const auto& near = nearest[b];
    const auto text = fmt::format("body \"{}\" touches nothing: {}{}", bodies[b].name,
                                  near.body < 0 ? "there is no other body, "
                                                : fmt::format("nearest is \"{}\", {:.4g} away, ",
                                                              bodies[static_cast<std::size_t>(near.body)].name, near.distance),
                                  why[b]);
    if (moving[b])
      loaded += "\n  " + text;
    else if (++told <= most) {
      Warning w{"untouched_body", text, "its rigid motions are set to zero: support it, or let a contact reach it"};
      w.body = bodies[b].name;
      w.value = near.distance;
      warnings.report(std::move(w), context.log);
    }
  }
  if (told > most) context.log.warning("... and {} more bodies that touch nothing", told - most);
  if (!loaded.empty())
    throw Error(ExitStatus::no_equilibrium,
                "no equilibrium: nothing resists the loads of these bodies:" + loaded +
                    "\nhold the body by a support, let a contact reach it (a larger search_distance), "
                    "or remove the load");
}

}  // namespace mortise::analysis
