// What was found inside bodies, as rows of tables and pieces of files.
#pragma once

#include <string>
#include <vector>

#include "analysis/load_step_solver.hpp"
#include "io/results.hpp"
#include "io/vtk.hpp"

namespace mortise {

/// Whether the deck's `output.fields` has this one.
bool wanted(const model::Deck& deck, const std::string& field);

/// A name as an entry of a table with commas.
std::string quoted(const std::string& name);

/// The tables `interior/..` of nodes inside boundary elements, which have the numbers after all others, and `points/..` of the
/// deck's points; those that are asked for. Collective.
std::vector<io::Table> interior_tables(const partition::Decomposition& decomposition, const post::Probes& probes,
                                       const post::Results& results, const Communicator& comm);

io::Piece plane_piece(const model::Deck& deck, const partition::Decomposition& decomposition, const post::PlaneSection& section,
                      const post::Values& values);

/// The first line of interior.csv.
std::string point_header(const model::Deck& deck);
/// The lines of one state, on the root. Collective.
std::string point_rows(const model::Deck& deck, const mesh::Catalogue& catalogue, const model::LoadState& acts,
                       const post::Probes& probes, const post::Values& values, const Communicator& comm);

}  // namespace mortise
