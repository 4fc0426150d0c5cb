// The search for forces that obey Coulomb's law, by one way after the other.
#pragma once

#include <optional>
#include <vector>

#include "friction/coulomb.hpp"

namespace mortise::friction {

/// Where the search ends, and what it tries next. Changes are those of slip bounds, relative.
struct SearchLimits {
  // Solved.
  static constexpr double obeyed = 2e-3;       ///< change up to which the law is; then the allowed error is asked for, by a sweep
  static constexpr double below_change = 0.1;  ///< of it, residual of a Tresca problem: no more exact than its bounds are known
  static constexpr double below_tolerance = 0.1;  ///< of the loop's tolerance, the same once bounds rest
  static constexpr double stricter = 0.1;         ///< times the residuals before, where bounds rest beside too large an error
  static constexpr int idle_steps = 3;  ///< without a smaller change: light groups of bodies feel what solutions leave of others
  static constexpr double slack = 1.5;  ///< of an allowed error, by what is next to nothing in energy at the limit of friction
  static constexpr double to_come = 100;  ///< changes that are still to come, at most, over the next one
  // Bounds that leave no feasible point.
  static constexpr int retreats = 4;        ///< half way back in a row, then bounds that surely leave one,
  static constexpr double room = 1 + 1e-6;  ///< times as large, for in a set of these it would be on the edge
  static constexpr double balanced = 1e-6;  ///< of all forces: what the search for such a point may leave
  // Given up.
  static constexpr int most_failures = 15;                 ///< problems without a feasible point
  static constexpr int steps_of_fall = 2, most_falls = 2;  ///< bounds that fell ever faster until they were too small, so often
};

/// The search of solve_coulomb(), which it is made for. What the problem and the means refer to outlives it. Collective.
class CoulombSearch {
 public:
  CoulombSearch(const CoulombProblem& problem, const CoulombMeans& means, const Observer& observer);
  CoulombSearch(const CoulombSearch&) = delete;
  CoulombSearch& operator=(const CoulombSearch&) = delete;

  CoulombSolution solve(const CoulombWays& ways);

 private:
  using Limits = SearchLimits;

  /// A solution of this load step.
  struct Found {
    qp::Solution solution;
    bool judged = false;  ///< what it breaks the law by counts in its error
    bool converged = false;
  };

  /// Bounds and forces together; nothing if the algorithm cannot, or finds bounds without a feasible point.
  std::optional<Found> follow_law();
  /// From what was found so far.
  Found fixed_point(std::optional<Found> found);
  /// Together by steps that may be shortened; nothing if that does not converge.
  std::optional<Found> follow_cautiously();
  /// Takes what bounds and normal forces still differ by for error; whether the whole is allowed. Only once of a solution.
  bool judge(Found& found);

  std::vector<double> radii_at(const Vector* lambda) const;
  qp::SlipLaw slip_law(bool cautious) const;
  void count(const qp::Solution& found);
  bool obeys_law(Found& found, const std::vector<double>& radii, double change);
  double change_of_bounds(const std::vector<double>& wanted, const std::vector<double>& now, const qp::Solution& at) const;
  bool believable(const qp::Solution& solution) const;
  // Of the fixed point; the Tresca problem's radii are those at work.
  std::vector<double> admitted_radii(const qp::Solution& found, const qp::Solution& infeasible) const;
  bool contacts_at_rest(const qp::Solution& solution) const;
  bool at_rest(Found& found, const std::vector<double>& wanted, double tolerance, const std::optional<double>& response);
  double error_of_bounds(const qp::Solution& solution, const std::vector<double>& wanted) const;

  const CoulombProblem problem_;
  const CoulombMeans means_;
  const qp::Observer watch_;
  std::vector<double> at_work_;  // radii of discs, see DualProblem::radii(): of the last problem that was solved, or tried
  double change_ = 1;
  int step_ = 0, outer_ = 0, preconditionings_ = 0;
};

}  // namespace mortise::friction
