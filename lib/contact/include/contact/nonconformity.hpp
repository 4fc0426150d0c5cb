// What the multipliers of a contact do not see of how its sides move against each other.
//
// Weak contact asks for jumps that fit in the mean over each multiplier's function. Between, sides pass through each other, or
// stand off, with nothing to stop it, a primary side of smaller faces most of all. In a bond that is the jump itself; in a
// contact what is left of it on a secondary face once the polynomials of the multipliers are taken out, which gaps and slopes
// between faces are not. It is the consistency error of mortar methods as it is found in a solution [Wohlmuth, SIAM J. Numer.
// Anal. 38 (2000), bounds it from the start].
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contact/mortar.hpp"
#include "contact/state.hpp"

namespace mortise::contact {

/// The displacement of a node, as plain bytes.
struct NodalDisplacement {
  Global node;
  std::array<double, 3> u;
};

/// Of one contact, over all its faces that press.
struct Nonconformity {
  /// sum over faces of max(|w|^2 / size, |w| |grad w| / (2 pi)), the norms being those of the integrals over a face of squares,
  /// and w the jump or what is left of it: across the face where it presses, along it where it sticks; areas as in the model. E
  /// pi of it is about the square of the energy norm of a half-space that follows w, which is E |w| |grad w| / 2 for waves.
  double squared = 0;
  double largest = 0;        ///< the largest |w|, across or along the face, a length
  Point at = Point::Zero();  ///< where that is, on the undeformed secondary side
};

/// One for each pair, the same on every rank; 0 of obstacles, pretension sections and cuts of sectors. `surfaces` as of
/// surface_states(); `displacements`: those of this rank's nodes of both sides at least, copies being the same. Collective.
std::vector<Nonconformity> nonconformities(std::span<const Pair> pairs, std::span<const SurfaceState> surfaces,
                                           std::span<const NodalDisplacement> displacements, fem::Kinematics kinematics,
                                           const Communicator& comm);

}  // namespace mortise::contact
