// Supports: what they prescribe, and the nodes and surfaces that they hold.
#include <algorithm>
#include <cmath>
#include <utility>

#include "model/model.hpp"
#include "points.hpp"

namespace mortise::model {

std::vector<constraint::Support> Model::supports(const LoadState& state) const
{
  std::vector<constraint::Support> supports;
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& options = deck_.supports[i];
    auto& support = supports.emplace_back();
    support.boundary = options.points.empty() ? options.boundary : "points";
    support.name = options.name;
    if (!options.axes.empty()) support.axes = local_axes(deck_, options.axes);
    if (!options.coupling.empty() || !state.acting[i]) continue;  // motions of points are those of their couplings
    const auto act = [&](const std::optional<deck::Formula>& value) -> std::optional<deck::Formula> {
      return value ? std::optional(value->at(state.support[i], state.time)) : std::nullopt;
    };
    for (std::size_t c = 0; c < 3; ++c) support.displacement[c] = act(options.displacement[c]);
    support.normal = act(options.normal);
  }
  if (deck_.axisymmetric()) {
    supports.emplace_back().boundary = "the axis of revolution";
    supports.back().displacement[0] = 0.0;
  }
  for (const auto& [name, coupling] : deck_.couplings) {
    supports.emplace_back().boundary = "coupling " + name;
    supports.back().name = name;
  }
  return supports;
}

std::vector<constraint::SupportNodes> Model::support_nodes(std::span<const constraint::Support> supports,
                                                           const Communicator& comm) const
{
  std::vector<constraint::SupportNodes> nodes(supports.size());
  const auto places = nodes_at_points(comm);
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& support = deck_.supports[i];
    if (!support.points.empty()) {
      for (const auto& found : places.supports[i]) {
        if (found.subdomain < 0 || decomposition_.rank_of(found.subdomain) != comm.rank()) continue;
        nodes[i].id.push_back(found.node);
        nodes[i].at.push_back(found.at);
      }
    } else if (!support.boundary.empty()) {
      const auto [boundary, on_body] = select(support.boundary);
      auto surface = partition::boundary_surface(decomposition_, boundary, on_body);
      nodes[i] = {std::move(surface.node_id), std::move(surface.points)};
    }
  }
  if (!deck_.axisymmetric()) return nodes;
  const double near = rounding(comm);
  auto& on_axis = nodes[deck_.supports.size()];
  for (const auto& subdomain : decomposition_.subdomains)
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
      if (std::abs(subdomain.mesh.points[n][0]) <= near) {
        on_axis.id.push_back(subdomain.mesh.node_id[n]);
        on_axis.at.push_back(subdomain.mesh.points[n]);
      }
  return nodes;
}

std::vector<mesh::Surface> Model::support_surfaces() const
{
  std::vector<mesh::Surface> surfaces;
  for (const auto& support : deck_.supports) {
    surfaces.emplace_back();
    if (!support.normal) continue;
    const auto [boundary, on_body] = select(support.boundary);
    surfaces.back() = partition::boundary_surface(decomposition_, boundary, on_body);
  }
  surfaces.resize(surfaces.size() + deck_.couplings.size());
  if (deck_.axisymmetric()) surfaces.emplace_back();
  return surfaces;
}

std::vector<mesh::Surface> Model::surfaces_prescribed_along_normals(const LoadState& state) const
{
  std::vector<mesh::Surface> surfaces;
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& support = deck_.supports[i];
    const bool on_springs = support.stiffness.normal && !support.stiffness.tangential;
    if (!state.acting[i] || !(support.normal || on_springs)) continue;
    const auto [boundary, on_body] = select(support.boundary);
    surfaces.push_back(partition::boundary_surface(decomposition_, boundary, on_body));
  }
  return surfaces;
}

std::vector<bool> Model::supported(const std::vector<bool>& touched, const Communicator& comm) const
{
  const std::size_t bodies = decomposition_.catalogue.bodies.size(), couplings = deck_.couplings.size();
  const auto places = nodes_at_points(comm);
  std::vector<double> faces((couplings + 1) * bodies, 0.0);  // of each body in each coupling; last: under supports
  const auto count_faces = [&](const std::string& name, std::size_t row) {
    const auto [boundary, on_body] = select(name);
    for (const int body : partition::boundary_surface(decomposition_, boundary, on_body).body)
      faces[row * bodies + static_cast<std::size_t>(body)] += 1;
  };
  std::size_t row = 0;
  for (const auto& [name, coupling] : deck_.couplings) count_faces(coupling.boundary, row++);
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& support = deck_.supports[i];
    for (const auto& found : places.supports[i])
      if (found.subdomain >= 0 && decomposition_.rank_of(found.subdomain) == comm.rank())
        faces[couplings * bodies + static_cast<std::size_t>(found.body)] += 1;
    if (support.points.empty())
      count_faces(support.coupling.empty() ? support.boundary : deck_.couplings.at(support.coupling).boundary, couplings);
  }
  comm.sum_in_place(faces);

  std::vector<std::vector<std::size_t>> tied(couplings);  // bodies that move together
  for (std::size_t c = 0; c < couplings; ++c)
    for (std::size_t b = 0; b < bodies; ++b)
      if (faces[c * bodies + b] > 0) tied[c].push_back(b);
  for (const auto& ends : places.springs) {
    auto& two = tied.emplace_back();
    for (const auto& end : ends)
      if (end.subdomain >= 0) two.push_back(static_cast<std::size_t>(end.body));
  }
  std::vector<bool> result = touched;
  for (std::size_t b = 0; b < bodies; ++b)
    if (faces[couplings * bodies + b] > 0) result[b] = true;
  for (bool more = true; std::exchange(more, false);)
    for (const auto& group : tied) {
      const auto is_supported = [&](std::size_t b) { return result[b]; };
      if (std::ranges::none_of(group, is_supported) || std::ranges::all_of(group, is_supported)) continue;
      for (const std::size_t b : group) result[b] = true;
      more = true;
    }
  return result;
}

}  // namespace mortise::model
