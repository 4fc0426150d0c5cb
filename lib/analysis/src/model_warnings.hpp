// Warnings before the solution that ask more of the model than lib/post knows: its deck, its names and its mesh as it was read.
#pragma once

#include <vector>

#include "analysis/rows.hpp"
#include "base/warning.hpp"

namespace mortise::analysis {

/// "idle_contact": contacts without a point, which do nothing: the bodies would pass through each other unnoticed. Collective.
std::vector<Warning> idle_contacts(const Rows& rows, const Communicator& comm);

/// "coarser_than_asked": an edge of a cell is longer than twice mesh.size.max. A geometry that says itself where nodes lie
/// (Transfinite, Layers of Extrude) does not obey that, and gmsh is silent. Collective.
std::vector<Warning> coarser_than_asked(const model::Model& model, const Communicator& comm);

/// "doubled_nodes" and "hanging_nodes": faces of one body that lie on each other without common nodes: a seam that was to be
/// merged, cells that were to fit, or a crack. Collective.
std::vector<Warning> unconnected_faces(const model::Model& model, const Communicator& comm);

/// "uncovered_temperatures": nodes that a file of temperatures does not reach have what is found nearest to them, or what a
/// straight line leads to. Collective.
std::vector<Warning> uncovered_temperatures(const model::Model& model, const Communicator& comm);

}  // namespace mortise::analysis
