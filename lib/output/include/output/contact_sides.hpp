// The secondary sides of contacts with their state, as this rank's part of contact.pvd.
#pragma once

#include <span>

#include "contact/state.hpp"
#include "io/vtk.hpp"

namespace mortise::output {

/// Of all contacts the faces with a node that lies near enough to the other side to have a state; nodes of these that lie farther
/// show the largest gap of the faces round them.
io::Piece contact_sides(std::span<const contact::Pair> pairs, std::span<const contact::SurfaceState> states);

}  // namespace mortise::output
