// The secondary sides of contacts with their state, as this rank's part of contact.pvd.
#pragma once

#include <span>

#include "contact/state.hpp"
#include "io/vtk.hpp"

namespace mortise::output {

/// The faces of all contacts with a node that lies near enough to the other side to have a state; other nodes of these faces show
/// the largest gap of the faces round them.
io::Piece contact_sides(std::span<const contact::Pair> pairs, std::span<const contact::SurfaceState> states);

}  // namespace mortise::output
