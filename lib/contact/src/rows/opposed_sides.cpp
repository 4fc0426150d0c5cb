#include "rows/opposed_sides.hpp"

#include "search/over_facets.hpp"

namespace mortise::contact {

OpposedSides::OpposedSides(const Options& its_options, const Share& its_share, double its_reach, int its_index,
                           const SupportDirectory& directory, const FacesAtBonds& at_bonds, fem::Kinematics kinematics,
                           const Communicator& comm)
    : options(its_options),
      index(its_index),
      reach(its_reach),
      dimension(fem::dimension(kinematics)),
      axisymmetric(kinematics == fem::Kinematics::axisymmetric),
      share(its_share),
      secondary(share.secondary),
      primary(share.primary),
      supports(directory, secondary.node_id, comm),
      primary_supports(directory, primary.node_id, comm),
      primary_at_bonds(at_bonds.nodes_of(primary, comm)),
      nodes(find_surface_nodes(secondary, supports, at_bonds, at_bonds.nodes_of(secondary, comm))),
      primary_nodes(find_surface_nodes(primary, primary_supports, at_bonds, primary_at_bonds)),
      faces(secondary, nodes, share.own, bonded() ? 3 : 1),
      tree(tree_of_facets(primary)),
      sight(secondary, primary, tree),
      rays(secondary, nodes, primary, primary_nodes, tree, sight, options.obstacle, reach),
      mesh_gaps(!bonded() && !options.clearance),
      nearest(mesh_gaps ? find_nearest_points() : std::vector<NearestPoint>()),
      bonded_nodes(tied_together(primary_at_bonds)),
      discretization(discretization_kind(options.discretization)
                         .make({secondary, nodes, primary, primary_nodes, tree, sight, faces, rays, options.obstacle.has_value(),
                                reach, mesh_gaps, !bonded(), nearest, bonded_nodes}))
{
}

std::vector<NearestPoint> OpposedSides::find_nearest_points()
{
  OverFacets over(secondary, primary, primary_nodes, tree, sight, rays, reach);
  return nearest_points(secondary, nodes, faces.round(), rays, over);
}

}  // namespace mortise::contact
