// The search for forces that obey Coulomb's law, by one way after the other.
#pragma once

#include <optional>
#include <vector>

#include "friction/coulomb.hpp"

namespace mortise::friction {

/// The search of solve_coulomb(), which it is made for. What the problem and the means refer to outlives it. Collective.
class CoulombSearch {
 public:
  CoulombSearch(const CoulombProblem& problem, const CoulombMeans& means, const Observer& observer);
  CoulombSearch(const CoulombSearch&) = delete;
  CoulombSearch& operator=(const CoulombSearch&) = delete;

  CoulombSolution solve(const CoulombWays& ways);

 private:
  /// Bounds and forces together, if the algorithm can.
  void follow_law();
  /// From what was found so far.
  void fixed_point();
  void follow_cautiously();
  /// Takes what bounds and normal forces still differ by for error; whether the whole is allowed. Only once of a solution.
  bool judge(qp::Solution& solution);

  std::vector<double> radii_at(const Vector* lambda) const;
  qp::SlipLaw slip_law(bool cautious) const;
  void count(const qp::Solution& found);
  bool obeys_law(qp::Solution& found, const std::vector<double>& radii, double change);
  double change_of_bounds(const std::vector<double>& wanted, const std::vector<double>& now, const qp::Solution& at) const;
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
  bool judged_ = false;                         // and what it breaks the law by counts in its error
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
  std::optional<double> response_;  // how much of a change of bounds the normal forces answer with, if it is known
};

}  // namespace mortise::friction
