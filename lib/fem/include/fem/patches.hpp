// Stresses recovered by polynomials on patches of cells: round every corner of the cells their stresses, where these are most
// exact, are fitted, by least squares weighted by volume, by a polynomial of the cells' order [Zienkiewicz and Zhu, The
// superconvergent patch recovery and a posteriori error estimates, IJNME 33 (1992)]. A node inside takes the value of its own
// polynomial. A node at the border of a body, or of a material in it, takes those of the nodes inside that share a cell with it:
// its own patch, of one or two cells at a corner, knows next to nothing of a stress that is steep there. Where no node lies
// inside, in one layer of cells, the patches at the border serve; of rectangles, bricks and prisms of first order nothing is
// recovered there.
//
// Everything is sums over cells, so that pieces of one body only have to add up what they know of the nodes that they share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/constitution.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// What a piece knows of the patches round its corners.
struct Patches {
  int order = 1;           ///< of the polynomials, at most
  std::vector<Local> row;  ///< of each node: its column in `sums`; -1 for the middle of an edge, a face or a cell
  /// (width x blocks) x corners, a block for each material: the normal equations about the node, the cells of second order, and
  /// the area vectors of the cells' faces with their sum of lengths, which vanish round a node inside.
  Eigen::MatrixXd sums;
};

/// The largest order of a cell: 1 or 2.
int largest_order(const mesh::Mesh& mesh);

/// The sums of the cells of this piece; `order`: at least that of its cells, the same on all pieces.
Patches patch_sums(const mesh::Mesh& mesh, const Constitution& constitution, Kinematics kinematics, const Eigen::VectorXd& u,
                   std::size_t blocks, int order);

/// Adds to the sums about a corner, which are those over all pieces, their mirror images in the plane through it with the unit
/// normal `normal`, as cells beyond the plane would have them.
void add_mirror_image(Patches& patches, Local corner, const Point& normal, Kinematics kinematics);

/// From sums over all pieces: nodes x 7 blocks, sums over the cells of this piece of weight * stress, and of the weights, as
/// StressField::nodal_sums has them; weights that add up to nothing where nothing is recovered.
Eigen::MatrixXd patch_stresses(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const Patches& patches,
                               std::size_t blocks);

}  // namespace mortise::fem
