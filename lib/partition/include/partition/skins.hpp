// Subdomains that are known by their surface alone, as boundary elements need them: panels instead of cells.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "partition/decomposition.hpp"

namespace mortise::partition {

/// The same subdomains, those of the bodies that `of_body` marks (one entry per body) as skins (Subdomain::skin).
///
/// The panels of a skin are the faces that belong to one cell of the subdomain, cut into triangles (plane models: lines) that
/// look out of it, as mesh::Face does. They take all nodes of a face: a quad4 makes 2, cut along the diagonal through its node of
/// the smallest number, a tri6 4, a quad8 6, a quad9 8, a line3 2. Faces of second order thus become polyhedra. From both sides
/// of an interface the triangles are the same. Where a body stands in its file as its surface alone (mesh::Body), the faces are
/// its cells. A facet of a boundary becomes one facet for each of its panels, its parent.
///
/// Nodes and cells are numbered anew, in the order that they had: first the nodes that remain, 0 .. node_count-1, then those that
/// are only inside; the panels of a cell take its place. The numbers do not depend on the number of ranks. Subdomains with the
/// same cells in the same local numbering get the same panels in the same local numbering. Subdomains, clusters and ranks stay.
/// `keep_inside`: fill Subdomain::inside where there are cells. Collective.
Decomposition skins(Decomposition decomposition, const std::vector<bool>& of_body, bool keep_inside, const Communicator& comm);

}  // namespace mortise::partition
