// Exact solution of a quadratic programme whose Hessian is at hand as a matrix: a direct method for contact, for programmes of
// some thousand unknowns. Every unknown without a constraint is eliminated once,
//
//     W = A_cc - A_cf A_ff^-1 A_fc,   H = G_c - G_f A_ff^-1 A_fc,   C = C_0 + G_f A_ff^-1 G_f',
//
// W the compliance of the contact, C_0 what an elimination before this one has left: G x - C_0 nu = e. What is left,
// W x + H'nu - b = s, H x - C nu = e, s in the normal cone of Omega at x, is solved by a semismooth Newton method [Hueeber,
// Stadler and Wohlmuth, SIAM J. Sci. Comput. 30 (2008)]: guess the state of every constraint, solve the linear problem that is
// left, guess again. Radii of discs with a coefficient follow their normal unknown: Coulomb's law is solved as a whole.
//
// Guesses can take turns for ever, where friction passes forces on from point to point. So if they do not converge at once,
// contact becomes soft first, W + a D with the compliance D of each unknown alone, and hardens again: a soft contact has
// converged in three steps from anywhere, and each next one in as many from there. Where that fails, as on plates that bend, an
// interior point method leads near the solution (src/central_path.hpp), and guesses go on from there.
#pragma once

#include <Eigen/Cholesky>

#include "qp/feasible_set.hpp"

namespace mortise::qp {

/// What is left when unknowns without a constraint are eliminated.
struct CondensedMatrices {
  Eigen::MatrixXd w, h, c;  ///< W: constrained unknowns squared; H: rows of G x constrained unknowns; C: rows of G squared
  Eigen::VectorXd own;      ///< compliance of each unknown if all others are fixed: 1 / (W^-1)_ii
};

/// On one rank alone. Heavy: moves, does not copy.
class CondensedNewton {
 public:
  /// A: symmetric, positive definite. `g`: G, dense, rows x unknowns. `c`: C_0, symmetric, positive semidefinite. `set`: over all
  /// unknowns; later ones may differ from it in radii and bounds. Throws Error(not_converged) if A is not definite, and, as
  /// solve() does, Error(interrupted) if the process is told to end.
  CondensedNewton(Eigen::MatrixXd a, Eigen::MatrixXd g, Eigen::MatrixXd c, const FeasibleSet& set);

  struct Result {
    Eigen::VectorXd x, nu;          ///< A x - b + G'nu in the normal cone of -Omega, G x - C_0 nu = e
    bool converged = false;         ///< to rounding; else the last guess
    int steps = 0;                  ///< linear problems solved
    Eigen::VectorXd reaction = {};  ///< A x - b + G'nu, zero at unknowns without a constraint
    /// If it did not converge: x are forces under which bodies slide along each other for ever, nu is somewhere on their way.
    bool slides = false;
    bool settled = true;           ///< if it converged: with states that the next guess left as they are, not by rounding alone
    Eigen::VectorXd nu_rest = {};  ///< what nu lacks after its last figure, where that is known: forces may feel it
  };
  /// For the linear term b and the right-hand side e. `near`: the solution of a problem before, if it converged, or a guess at
  /// this one's, with its reaction, from whose states guesses go on; nothing else is tried then.
  Result solve(const Eigen::VectorXd& b, const Eigen::VectorXd& e, const FeasibleSet& set, const Result* near = nullptr) const;
  /// Whether rows depend on each other, and so A has been given a little compliance more.
  bool separated() const { return separated_; }
  /// A^-1 r, over all unknowns.
  Eigen::VectorXd inverse_times(const Eigen::VectorXd& r) const;

 private:
  void factorize_free(Eigen::MatrixXd a);
  void measure();

  std::vector<Local> constrained_, others_;  // unknowns
  CondensedMatrices matrices_;
  Eigen::LLT<Eigen::MatrixXd> free_, contact_;  // of A_ff and W
  Eigen::MatrixXd coupling_;                    // A_ff^-1 A_fc
  Eigen::MatrixXd motion_;                      // A_ff^-1 G_f'
  bool separated_ = false;
};

}  // namespace mortise::qp
