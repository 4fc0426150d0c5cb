// Cyclic symmetry: of n equal sectors one is meshed. Its primary boundary meets, or is one with, the secondary boundary of the
// sector before. Rotated by the sector's angle, x -> R x + t, it lies on the secondary boundary of its own sector, and its
// displacements are rotated with it: u(R x + t) = R u(x).
#pragma once

#include <memory>
#include <string>

#include "contact/options.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// The motion x -> R x + t of a cyclic pair's primary side; none for other pairs.
std::optional<mesh::Motion> rotation_of(const Options& options);

/// The surface after that motion; itself if there is none.
mesh::Surface rotated(mesh::Surface surface, const Options& options);

/// Why a contact's `cyclic` does not fit models of this kind, or its angle is no n-th part of a full turn: a message, or "".
std::string misfit(const mesh::RotationOptions& cyclic, fem::Kinematics kinematics);

}  // namespace mortise::contact
