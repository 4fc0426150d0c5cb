// The linear problem that is left of a condensed programme once the state of every constraint is guessed, and its solution with
// the factors of an earlier guess.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <functional>
#include <optional>
#include <vector>

#include "contact_system.hpp"
#include "qp/condensed_newton.hpp"

namespace mortise::qp {

/// M a + B nu = r, N a - C nu = l, with M = E'(W + S) T + curvatures, B = E'H', N = H T; T and E hold trial and test directions
/// as columns, S is diagonal.
class MoveProblem {
 public:
  /// `matrices` and `softening`, the diagonal S, outlive it. `symmetric`: trial and test are alike.
  MoveProblem(const CondensedMatrices& matrices, const Eigen::VectorXd& softening, std::vector<Move> moves, bool symmetric);

  Eigen::VectorXd extend(const Eigen::VectorXd& a) const;  ///< T a
  Eigen::VectorXd test(const Eigen::VectorXd& x) const;    ///< E'x

  const CondensedMatrices& matrices() const { return matrices_; }
  const Eigen::VectorXd& softening() const { return softening_; }
  const std::vector<Move>& moves() const { return moves_; }
  bool symmetric() const { return symmetric_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(moves_.size()); }
  const Eigen::MatrixXd& matrix() const { return matrix_; }  ///< M
  const Eigen::MatrixXd& push() const { return push_; }      ///< B
  const Eigen::MatrixXd& motion() const { return motion_; }  ///< N

 private:
  Eigen::MatrixXd make_matrix() const;

  const CondensedMatrices& matrices_;
  const Eigen::VectorXd& softening_;
  std::vector<Move> moves_;
  bool symmetric_;
  Eigen::MatrixXd matrix_, push_, motion_;
};

/// Factors of the matrix of one problem, which solve it, and which lead to the solution of another one whose states differ at
/// some points by a few steps of GMRES [Saad and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986)]: M^-1 of the new problem is taken
/// for E'T0 M0^-1 E0'E, and for the compliance of a point alone where the old one had it fixed.
class MoveFactor {
 public:
  using Solve = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;
  /// `solve`: M0^-1 of the problem that has these moves.
  MoveFactor(std::vector<Move> moves, Solve solve) : moves_(std::move(moves)), solve_(std::move(solve)) {}
  /// That of `problem`; throws as factorize().
  explicit MoveFactor(const MoveProblem& problem);

  /// Its own problem: M0^-1 right.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const { return solve_(right); }

  struct Solution {
    Eigen::VectorXd amount, nu;
  };
  /// a and nu of `problem`, nearer than `start` by four figures or to rounding. Nothing if that takes more than `most` steps, or
  /// if a motion is not held. `scale`: the squares of what lacks of N a - C nu are measured by. Throws as stop_if_requested.
  std::optional<Solution> iterate(const MoveProblem& problem, const Eigen::VectorXd& r, const Eigen::VectorXd& l,
                                  const Eigen::VectorXd& scale, const Solution& start, int most) const;
  /// Steps of GMRES on `problem` that take as long as new factors of it.
  int affordable_steps(const MoveProblem& problem) const;

 private:
  class Inverse;

  std::vector<Move> moves_;
  Solve solve_;
};

}  // namespace mortise::qp
