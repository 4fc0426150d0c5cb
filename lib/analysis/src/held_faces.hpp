// Faces of cells of first order that reach from one held side of a body to another: in one layer of cells no node between the
// sides is free.
#pragma once

#include <vector>

#include "analysis/rows.hpp"
#include "fem/held_faces.hpp"
#include "partition/node_homes.hpp"

namespace mortise::analysis {

/// Nodes of bonds and contacts whose neighbours have rows in their stead.
std::vector<Global> nodes_without_rows(const constraint::Contacts& contacts);

/// Faces all of whose nodes are held, in every direction by supports, couplings, bonds or friction, or across a contact. Between
/// cells, and outer ones with a known traction: not those of contacts, nor where supports or couplings act, or loads other than
/// pressure. Of each subdomain of this rank, by cells. `homes` knows the nodes in the rows of contacts and those without.
/// Collective.
std::vector<std::vector<fem::HeldFace>> find_held_faces(const model::Model& model, const Rows& rows,
                                                        const partition::NodeHomes& homes, const Communicator& comm);

}  // namespace mortise::analysis
