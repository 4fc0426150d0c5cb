// Contact surfaces in a solved equilibrium: the state of each point, resultants, fields.
#pragma once

#include <vector>

#include "contact/state.hpp"
#include "feti/dual_problem.hpp"

namespace mortise::post {

struct ContactResults {
  std::vector<contact::ContactNodeState> states;  ///< of this rank's contact nodes
  std::vector<contact::ContactNodeState> shown;   ///< these with their images across bonds
  std::vector<contact::Resultant> resultants;     ///< of each contact
  std::vector<contact::SurfaceState> surfaces;    ///< of each contact, its secondary side on this rank
  std::vector<double> tensions;                   ///< of each contact: the largest tension, force over area at one point
  double penetration = 0;                         ///< the largest, a length; bonded contacts aside
  double work_of_gaps = 0;                        ///< sum of |gap * normal force|, which is zero in contact
};

/// At the multipliers lambda of rows and nu of kernels; `slip_bounds`: forces, see feti::DualSolution; `displacement`: of each
/// subdomain. A contact, bonded ones aside, whose
/// forces are all below 1e-10 of the largest force of a row, or of `largest_force` of the states before, is open with forces of
/// 0. Collective.
ContactResults contact_results(const feti::DualProblem& problem, const Vector& lambda, const Eigen::VectorXd& nu,
                               std::span<const double> slip_bounds, const std::vector<Eigen::VectorXd>& displacement,
                               std::span<const contact::Pair> pairs, double largest_force);

}  // namespace mortise::post
