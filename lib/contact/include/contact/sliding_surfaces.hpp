// Which rigid motions let a surface slide along itself, as the mesh knows it: the pin in its hole, the ball in its cup.
//
// On a mesh of a cylinder n . v of the motion along the axis is not zero: facets tilt by some part of the angle between them. But
// their tilt wavers from face to face, and its integral over many faces depends on the border alone, so that little is left of it
// in polynomials of low degree. What tilts a surface on purpose, a cone or a wedge, stands there.
#pragma once

#include <span>
#include <vector>

#include "constraint/sliding_surface.hpp"
#include "contact/mortar.hpp"

namespace mortise::contact {

/// A SlidingSurface for each contact that is neither bonded nor cyclic and each body on each of its sides, from the faces that
/// its rows push on (all faces where supports hold every node of them). Ordered by contact, side (primary first) and body; the
/// same on every rank. Collective.
std::vector<constraint::SlidingSurface> sliding_surfaces(std::span<const Pair> pairs, const constraint::Contacts& contacts,
                                                         fem::Kinematics kinematics, const Communicator& comm);

}  // namespace mortise::contact
