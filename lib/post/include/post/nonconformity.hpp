// What of the mesh's error stresses do not show: sides of a contact that pass through each other where no multiplier sees it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/warning.hpp"
#include "contact/nonconformity.hpp"
#include "post/strength.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::post {

/// Of one contact.
struct ContactError {
  double squared = 0;  ///< in the energy norm, over all ranks
  double deepest = 0;  ///< how far its sides pass through each other, a length
  Point at = Point::Zero();
};

/// Of each contact. What the rows leave of the normal jump, w of contact::nonconformities(), is taken for a wave of the length of
/// the face on a half space of the softer body: its square in the energy norm is 2 pi / size E / 2 integral w^2. `surfaces` as of
/// contact::surface_states(). Collective.
std::vector<ContactError> contact_errors(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                                         std::span<const contact::Pair> pairs, std::span<const contact::SurfaceState> surfaces,
                                         const Communicator& comm);

/// "coarse_secondary": a contact's part of the mesh's error exceeds half of it, and 2 % of the solution, in the energy norm: the
/// faces of its secondary side are too large for what the primary one does between them. `errors` as of contact_errors().
std::vector<Warning> coarse_secondaries(std::span<const ContactError> errors, const MeshError& error,
                                        std::span<const contact::Pair> pairs);

}  // namespace mortise::post
