// The two sides of one contact on a rank, before anything is integrated: what is known of them from their meshes and supports.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contact/cyclic.hpp"
#include "contact/mortar.hpp"
#include "integrals/cut_faces.hpp"
#include "rows/discretization.hpp"
#include "rows/supported_nodes.hpp"
#include "search/line_of_sight.hpp"
#include "search/nearest_points.hpp"
#include "search/opposite.hpp"
#include "search/share.hpp"
#include "search/tree.hpp"
#include "surface/continued_side.hpp"

namespace mortise::contact {

/// Parts that refer to each other. Neither copies nor moves.
struct OpposedSides {
  /// `index`: of the contact; `reach`: what lies farther away does not count. `options` and `share` outlive it. Collective.
  OpposedSides(const Options& options, const Share& share, double reach, int index, const SupportDirectory& supports,
               const FacesAtBonds& at_bonds, fem::Kinematics kinematics, const Communicator& comm);
  OpposedSides(const OpposedSides&) = delete;
  OpposedSides& operator=(const OpposedSides&) = delete;

  bool bonded() const { return options.law == Law::bonded; }
  Global node_of(std::size_t surface_node) const
  {
    return secondary.node_id[static_cast<std::size_t>(nodes.all[surface_node].node)];
  }
  /// Whether this rank makes the rows of a place, see CutFaces::places().
  bool own(std::size_t place) const
  {
    return share.own[static_cast<std::size_t>(nodes.all[faces.surface_node(place)].node)] != 0;
  }

  const Options& options;
  const int index;
  const double reach;
  const int dimension;  ///< 2 or 3
  const bool axisymmetric;
  const Share& share;
  const Side &secondary, &primary;
  SupportedNodes supports, primary_supports;
  std::vector<FacesAtBonds::AtBond> primary_at_bonds;
  SurfaceNodes nodes, primary_nodes;
  CutFaces faces;  ///< of the secondary side; once dual, those near have their share of the rows
  Tree tree;
  LineOfSight sight;  ///< of the primary facets
  Rays rays;
  const bool mesh_gaps;                          ///< it starts with the gaps of the meshes
  std::vector<NearestPoint> nearest;             ///< of each surface node, or none
  std::vector<std::vector<Local>> bonded_nodes;  ///< of the primary side
  std::unique_ptr<Discretization> discretization;

 private:
  std::vector<NearestPoint> find_nearest_points();
};

}  // namespace mortise::contact
