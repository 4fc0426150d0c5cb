// What of the mesh's error stresses do not show: sides of a contact that pass through each other where no multiplier sees it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/warning.hpp"
#include "contact/nonconformity.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::post {

/// Of one contact, squares in the energy norm over all ranks.
struct ContactError {
  double squared = 0;         ///< that of the contact,
  double squared_beside = 0;  ///< that which stresses show in its softer bodies,
  double squared_norm = 0;    ///< and of the solution there
  double largest = 0;         ///< how far its sides miss each other, a length
  Point at = Point::Zero();
};

/// Of each contact. What the rows leave of the jump, w of contact::nonconformities(), is taken for a wave on a half
/// space of the softer body, of the length of the face or a shorter one: its square in the energy norm is k E / 2 integral w^2
/// with the wave number k. `surfaces` as of contact::surface_states(). Collective.
std::vector<ContactError> contact_errors(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                                         const StressField& stress, std::span<const contact::Pair> pairs,
                                         std::span<const contact::SurfaceState> surfaces, const Communicator& comm);

/// "coarse_secondary": a contact's error exceeds 0.65 times what stresses show in its softer bodies, 5 % of the solution there,
/// and 0.1 % of all of it, `squared_norm`, in the energy norm: the faces of its secondary side are too large for what the primary
/// one does between them.
std::vector<Warning> coarse_secondaries(std::span<const ContactError> errors, double squared_norm,
                                        std::span<const contact::Pair> pairs);

}  // namespace mortise::post
