#include "rows/integrated_contact.hpp"

#include <cmath>
#include <utility>

#include "rows/contact_nodes.hpp"
#include "rows/contact_points.hpp"

namespace mortise::contact {

namespace {

constexpr double no_part = 1e-6;  // of a facet's corner, in what lies opposite a node

}  // namespace

IntegratedContact integrate(std::unique_ptr<OpposedSides> sides, const Communicator& comm)
{
  auto& s = *sides;
  const auto cover = [&](std::size_t face) { return s.discretization->cover(face); };
  auto between = take_contact_points(s.nearest, s.secondary, s.nodes, s.faces, s.share.own, cover, comm);
  for (const std::size_t f : s.faces.round()) s.discretization->add_face(f, between.in_facets[f] != 0);
  RowsBetween rows(std::move(between.places), s.secondary, s.share.own, comm);
  s.faces.number_corners();
  std::vector<char> matches;
  if (s.bonded()) matches = on_matching_faces(s.secondary, s.nodes, s.faces, s.rays, s.share.own, comm);
  return {std::move(sides), std::move(rows), std::move(matches)};
}

std::vector<CoveredNode> covered_nodes(IntegratedContact& bond)
{
  auto& s = *bond.sides;
  std::vector<CoveredNode> result;
  const auto cover = cover_of_nodes(s.faces, s.nodes.all.size());
  for (std::size_t p = 0; p < s.nodes.all.size(); ++p) {
    if (!s.own(p) || !(cover[p] > 0)) continue;
    CoveredNode node{s.node_of(p), s.index, bond.matches[p] != 0, cover[p]};
    node.cyclic = s.options.cyclic.has_value();
    node.preloaded = s.options.preload.has_value();
    if (const Opposite& opposite = s.rays.meet(p); !s.options.obstacle && std::isfinite(opposite.gap)) {
      const auto corners = s.primary.facets[opposite.facet];
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (opposite.hit.shape[static_cast<Eigen::Index>(k)] > no_part)
          node.opposite[k] = s.primary.node_id[static_cast<std::size_t>(corners[k])];
    }
    result.push_back(node);
  }
  return result;
}

}  // namespace mortise::contact
