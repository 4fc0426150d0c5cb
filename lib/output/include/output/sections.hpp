// What was found inside bodies: plane sections as pieces of files, points as rows of interior.csv.
#pragma once

#include <string>

#include "io/vtk.hpp"
#include "model/deck.hpp"
#include "post/interior.hpp"

namespace mortise::output {

/// This rank's part of plane.NAME.pvd, with the fields of the volume.
io::Piece plane_piece(const model::Deck& deck, const partition::Decomposition& decomposition, const post::PlaneSection& section,
                      const post::Values& values);

/// The first line of interior.csv.
std::string point_header(const model::Deck& deck);
/// The lines of one state, ascending by post::PointInBody::row, the same on every rank. Collective.
std::string point_rows(const mesh::Catalogue& catalogue, const model::LoadState& acts, const post::Probes& probes,
                       const post::Values& values, const Communicator& comm);

}  // namespace mortise::output
