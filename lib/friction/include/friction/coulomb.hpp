// Coulomb's law: the slip bound of a point is the coefficient times its normal force, which is not known before.
//
// A solver that can follow a slip law by itself (qp::SlipLaw) finds bounds and forces together. The fixed point repeats Tresca
// problems, each solved only as exactly as the bounds are known and started from the one before. The first step lets every point
// stick, so that a floating body that is pushed sideways has an equilibrium from the start.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "feti/dual_problem.hpp"
#include "friction/law.hpp"
#include "friction/options.hpp"
#include "qp/solver.hpp"

namespace mortise::friction {

/// One line of progress: the number of the Tresca problem, the relative change of the slip bounds before it, and where the solver
/// stands.
using Observer = std::function<void(int step, double change, const qp::Progress&)>;

/// The contact problem of one load step. Refers to its parts; they outlive it.
struct CoulombProblem {
  const feti::DualProblem& dual;
  const std::vector<Law>& laws;  ///< of each contact
  const qp::FeasibleSet& omega;  ///< Omega with the coefficients of the laws
  const qp::RightHandSide& right;
  qp::Goal goal;
  Options options;
};

/// By what it is solved. Refers to its parts; they outlive it.
struct CoulombMeans {
  qp::Solver& algorithm;  ///< of the programme with Omega
  qp::Hessian& hessian;
  qp::Budget& budget;
};

/// The search for forces that obey the law, from one call to the next. Calls throw Error(no_equilibrium) that names the body that
/// moves and how where no such forces balance the loads. All are collective.
class CoulombSearch {
 public:
  /// `start`: where it begins. What the problem and the means refer to outlives it.
  CoulombSearch(CoulombProblem problem, CoulombMeans means, std::optional<qp::Solution> start, Observer observer);
  CoulombSearch(const CoulombSearch&) = delete;
  CoulombSearch& operator=(const CoulombSearch&) = delete;

  /// Bounds and forces together, if the algorithm can.
  void follow_law();
  /// Tresca problems until their bounds are at rest, from what was found so far.
  void fixed_point();
  /// Once more together from `start`, by steps that may be shortened: for where neither of these converges.
  void follow_cautiously(const std::optional<qp::Solution>& start);
  /// Takes what bounds and normal forces still differ by for error, at the end.
  void judge();

  bool solved() const { return solved_; }        ///< whether there is a solution of this load step
  bool converged() const { return converged_; }  ///< whether its bounds are those that the law gives
  const qp::Solution& solution() const { return *solution_; }
  /// Radii of the last problem that was solved or tried.
  const std::vector<double>& radii() const { return at_work_; }
  int steps() const { return step_; }        ///< Tresca problems
  double change() const { return change_; }  ///< relative, of the slip bounds in the last step
  int outer_iterations() const { return outer_; }
  int preconditionings() const { return preconditionings_; }

 private:
  std::vector<double> radii_at(const Vector* lambda) const;
  qp::SlipLaw slip_law(bool cautious) const;
  void count(const qp::Solution& found);
  bool obeys_law(const qp::Solution& found, const std::vector<double>& radii, double change) const;
  double change_of_radii(const std::vector<double>& wanted, const std::vector<double>& now, const qp::Solution& at) const;
  bool believable() const;
  // Of the fixed point.
  bool solve_tresca(const qp::Goal& goal);
  void step_back();
  void admit();
  bool contacts_at_rest();
  bool at_rest(const std::vector<double>& wanted, double tolerance);
  double error_of_bounds(const std::vector<double>& wanted);
  void note_response(const std::vector<double>& wanted);

  const CoulombProblem problem_;
  const CoulombMeans means_;
  const qp::Observer watch_;
  std::vector<double> radii_, previous_radii_;  // of discs, see DualProblem::radii(): those that come next, and before
  std::vector<double> at_work_;                 // those of the last problem that was solved, or tried
  std::optional<qp::Solution> solution_;        // at first the start
  bool solved_ = false;                         // it is of this load step
  bool converged_ = false;
  double change_ = 1;
  int step_ = 0, outer_ = 0, preconditionings_ = 0;
  // Of the last Tresca problem that was infeasible, nu, and whether that proves it; and how many were, one after the other.
  Eigen::VectorXd escape_;
  bool proven_ = false;
  int infeasible_ = 0;
  // A Tresca problem's last radii, and those that its solution asks for; maybe none on this rank.
  bool any_answer_ = false;
  std::vector<double> answered_, answer_;
  double response_ = 1;  // how much of a change of bounds the normal forces answer with; 1: unknown
};

}  // namespace mortise::friction
