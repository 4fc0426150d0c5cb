// When a solver of quadratic programmes may stop, and what it returns.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "qp/limits.hpp"
#include "qp/problem.hpp"

namespace mortise::qp {

/// When a solve may stop.
struct Goal {
  double residual = 1e-4;  ///< natural residual over ||P b||
  /// If given, face Newton stops by this instead: the error, in the norm of A, that is good enough at the present point x with
  /// the multipliers nu. Asked for only where the error comes near. Collective.
  std::function<double(const Vector& x, const Eigen::VectorXd& nu)> allowed_error = {};
  /// With an allowed error, about what it is: from the last product, which was that with x. It may lose figures and costs no
  /// product; no solve stops by it. Collective.
  std::function<double(const Vector& x, const Eigen::VectorXd& nu)> expected_allowed_error = {};
  /// Whether the point x, which a solution differs from by about `change`, will do; asked where the error, or the residual, would.
  /// `argument` is that of the natural projection: how far it lies from the border of a constraint's half-line or disc tells how
  /// firmly its state is decided. Collective.
  std::function<bool(const Vector& x, const Vector& argument, const Vector& change)> contact_converged = {};
  /// How far the primal solution at x, nu is from fulfilling its constraints, over its own size: energy and residuals feel little
  /// of what is soft. Asked for last. Collective.
  std::function<double(const Vector& x, const Eigen::VectorXd& nu)> incompatibility = {};
  /// The size of what is solved for, in the norm of the error (that of A, as Solution::error). Asked for where a residual is
  /// small, since a small residual alone says little where A is badly conditioned; if absent, it is believed. Collective.
  std::function<double(const Vector& x, const Eigen::VectorXd& nu)> energy_norm = {};

  /// In the norm of A, with an allowed error: an error of this size counts as none if the solution is at most ten times as large.
  /// For solutions that are nothing beside those of the sequence's other problems, as the state without a load between push and
  /// pull.
  double negligible = 0;

  /// Part of the energy norm. An error below it ends face Newton whatever the residual: for a start from a direct solution.
  /// Without an allowed error only where the residual no longer becomes smaller, or the run would be given up.
  double exact = 0;

  /// Part of the energy norm that the error may be for a small residual to count as a solution. Displacements of what bends, and
  /// peaks of pressure, are off by some ten times as much. More where the residual is `rounding`, so that nothing can make the
  /// error smaller.
  double credible(bool rounding = false) const
  {
    using Every = limits::Every;
    return allowed_error || rounding
               ? Every::most_credible
               : std::max(std::min(std::sqrt(residual), Every::condition * residual), Every::least_credible);
  }
};

/// What a solve leaves, and what the next one of a sequence may start from.
struct Solution {
  /// Copies x, the gradient there, and nu.
  Solution(const Vector& point, const Vector& at_point, const Eigen::VectorXd& multipliers)
      : x(point, Teuchos::Copy), gradient(at_point, Teuchos::Copy), nu(multipliers)
  {
  }

  Vector x;            ///< in Omega up to the equality residual
  Vector gradient;     ///< A x - b
  Eigen::VectorXd nu;  ///< multipliers of G x = e: A x - b + G' nu lies in the normal cone of -Omega; same on all ranks
  bool converged = false;
  bool feasible = true;  ///< false: {G x = e} and Omega do not meet; nu is then a direction that proves it, x is not solved for
  /// Not feasible: x is in Omega and obeys Coulomb's law, but G x falls short of e, and bodies slide along each other for ever
  /// without a change of x. If radii a little larger than those of x leave no feasible point either, nothing else will come of
  /// it.
  bool slides = false;
  bool empty = false;  ///< not feasible, and nu proves it, see Projection::empty
  int outer_iterations = 0;
  int preconditionings = 0;
  int safeguards = 0;             ///< steps of face Newton that went up and were taken back
  double projected_gradient = 0;  ///< relative to ||P b|| or, if that is larger, a hundredth of ||A||^1/2 ||x||_A
  /// ||x - x*|| in the norm of A, estimated by face Newton; not a number of SMALSE-M, for which error_bound() serves.
  double error = std::numeric_limits<double>::quiet_NaN();
  double equality = 0;  ///< relative, ||Q x - Q x_e|| / ||P b|| in the scaling ||P A P|| = 1

  std::vector<double> radii = {};  ///< of the discs, those given or those that a law ended with

  double hessian_norm = 0;    ///< ||P A P||, kept from solve to solve
  double precision = 1;       ///< M of SMALSE-M, kept from solve to solve
  Eigen::VectorXd augmented;  ///< multipliers mu of the augmented Lagrangian of SMALSE-M, kept from solve to solve
};

}  // namespace mortise::qp
