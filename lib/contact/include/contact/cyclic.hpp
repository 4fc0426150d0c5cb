// Cyclic symmetry: of n equal sectors one is meshed. What its primary boundary meets, or is one with, is the secondary boundary
// of the sector before: turned by the sector's angle, x -> R x + t, it lies on that of its own, and u(R x + t) = R u(x).
#pragma once

#include <memory>
#include <string>

#include "contact/options.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// The motion of a cyclic pair's primary side; none for other pairs.
std::optional<mesh::Motion> rotation_of(const Options& options);

/// The surface after that motion; itself if there is none.
mesh::Surface rotated(mesh::Surface surface, const Options& options);

/// What of options.cyclic does not fit models of this kind, or is no n-th part of a full turn: a message, or "".
std::string misfit(const mesh::RotationOptions& cyclic, fem::Kinematics kinematics);

}  // namespace mortise::contact
