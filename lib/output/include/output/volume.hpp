// The bodies with their fields, as this rank's part of solution.pvd.
#pragma once

#include <string>
#include <vector>

#include "io/vtk.hpp"
#include "model/deck.hpp"
#include "post/results.hpp"

namespace mortise::output {

/// The subdomains of this rank as one mesh, in which the copies of a node are one. Where stresses jump between materials, a node
/// has a point for each material that meets there.
struct Volume {
  io::Piece piece;
  std::size_t materials = 1;
  std::vector<Global> ids;  ///< of the points, ascending: number of the node times `materials`, plus that of the material

  /// The place of a node's point, or where it would stand.
  Local point(Global node, std::size_t material) const;
};

/// Values at the nodes of each subdomain, nodes x components; zero inside boundary elements.
struct NodeValues {
  std::string name;
  int components = 1;
  std::vector<Eigen::MatrixXd> of_subdomain;
};

/// The material, counted as in Volume, of the cell `cell` of this rank's subdomain `s`; bodies of boundary elements have one.
std::size_t material_of(const partition::Subdomain& subdomain, const post::StressField& stress, std::size_t s, std::size_t cell);

/// The subdomains with the fields that the deck asks for and those of `more`; of boundary elements the cells inside, if they are
/// asked for. `displacement`: of each subdomain.
Volume make_volume(const model::Deck& deck, const partition::Decomposition& decomposition,
                   const std::vector<Eigen::VectorXd>& displacement, const post::Fields& fields,
                   const std::vector<NodeValues>& more);

}  // namespace mortise::output
