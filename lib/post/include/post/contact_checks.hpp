// Contact forces that do what a user may not expect: moments that are lost between two sides, friction across gaps, overlaps that
// press.
#pragma once

#include <span>
#include <vector>

#include "base/warning.hpp"
#include "contact/state.hpp"
#include "feti/dual_problem.hpp"
#include "partition/decomposition.hpp"

namespace mortise::post {

/// The moment about the origin of all forces of one contact, those on both of its sides together.
struct ContactMoment {
  double lost = 0;   ///< its length: 0 if the forces lie opposite each other, gap times shear if the sides lie apart
  double scale = 0;  ///< a moment: the sum of |force| times the distance of the forces from their centre, root mean square
  double sizes = 0;  ///< the sum of |force|
};

/// sum_n x_n x (B_c' lambda_c)_n of each contact c; 0 where one side is an obstacle or a sector's neighbour. `states`: as of
/// contact_results(). Collective.
std::vector<ContactMoment> contact_moments(const feti::DualProblem& problem, const Vector& lambda,
                                           const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                                           std::span<const contact::Pair> pairs,
                                           std::span<const contact::ContactNodeState> states);

/// "loose_fit": a contact with friction and an `interference` presses with less than 1e-9 of `modulus` * interference / `size`,
/// those of the softest material and of the largest body. Wedges that friction alone would keep together have come apart: both
/// are equilibria. Collective.
std::vector<Warning> loose_fits(std::span<const contact::ContactNodeState> states, std::span<const contact::Pair> pairs,
                                double modulus, double size, const Communicator& comm);

/// "tied_preload": a bolt that a given force draws together by less than 1e-5 force / (`modulus` sqrt(area of the contact)): its
/// two parts are tied otherwise, and the force does not leave the cut. `shortenings`: of each section; `areas`: of each contact.
std::vector<Warning> tied_preloads(std::span<const constraint::PretensionSection> sections, std::span<const double> shortenings,
                                   std::span<const double> areas, std::span<const contact::Pair> pairs, double modulus);

/// "lost_moment": the moments that the two sides of a contact feel differ by more than 1 % of ContactMoment::scale. A row joins
/// places that lie apart, and a shear force across a gap turns them: a bond over a gap, Tresca friction where it gapes, facets of
/// curved sides that do not match. `forces`: Balance::acting.
std::vector<Warning> lost_moments(std::span<const ContactMoment> moments, std::span<const contact::Pair> pairs, double forces);

/// "friction_across_gap": open points of a contact with Tresca's law, whose bound is given whether the sides touch or not, bear
/// more than a hundredth of its forces. `forces` as in lost_moments(). Collective.
std::vector<Warning> frictions_across_gaps(std::span<const contact::ContactNodeState> states,
                                           std::span<const contact::Pair> pairs, double forces, const Communicator& comm);

/// A contact as it started, and what it presses with.
struct StartedContacts {
  std::span<const constraint::ContactNode> nodes;     ///< of this rank
  std::span<const contact::ContactNodeState> states;  ///< their states, in the same order
  std::span<const contact::InitialGap> gaps;          ///< of each contact
  std::span<const contact::Pair> pairs;               ///< of each contact
  std::span<const contact::SurfaceState> surfaces;    ///< of each contact
};

/// "overlap" of a solution, where unasked_overlaps() has not told it: an overlap of the sides that no `interference` asks for
/// does more than half of all work, `work` (force times overlap; without loads it is all of it), and the contact presses with
/// more than 1e-6 of `modulus`, the smallest Young's modulus. Collective.
std::vector<Warning> pressing_overlaps(const StartedContacts& all, double work, double modulus, const Communicator& comm);

}  // namespace mortise::post
