// The row `smalse` of the table of solvers.
#include <algorithm>

#include "make_solvers.hpp"
#include "qp/error_estimate.hpp"
#include "qp/smalse.hpp"

namespace mortise::qp {

namespace {

class SmalseSolver : public Solver {
 public:
  SmalseSolver(const Programme& programme, ActiveSetPreconditioner* preconditioner)
      : programme_(programme), preconditioner_(preconditioner)
  {
  }

  Solution solve(const RightHandSide& right, std::span<const double> radii, const std::optional<Solution>& start,
                 const Goal& goal, const Observer& observer, Foreknown* /*known*/) override
  {
    const FeasibleSet set = programme_.set.with_radii(radii);
    return smalse_to_goal({programme_, right, set}, start, goal, preconditioner_, observer);
  }
  ActiveSetPreconditioner* preconditioner() override { return preconditioner_; }

 private:
  Programme programme_;
  ActiveSetPreconditioner* preconditioner_;
};

}  // namespace

Solution smalse_to_goal(const Problem& problem, std::optional<Solution> start, const Goal& goal,
                        ActiveSetPreconditioner* preconditioner, const Observer& observer)
{
  using Limits = limits::Smalse;
  double tolerance = goal.allowed_error ? limits::Every::loosest : goal.residual;
  int outer = 0;
  while (true) {
    Solution found = smalse(problem, start, tolerance, observer);
    found.outer_iterations = outer += found.outer_iterations;
    if (!found.feasible) return found;
    found.error = error_bound(problem, found, preconditioner);
    const auto believed = [&](bool rounding) {
      return believable(found.error, rounding_of_error(problem.right.b, found.hessian_norm), found.x, found.nu, goal, rounding);
    };
    if (!found.converged) {
      // Finer than the goal, and no steps make the residual smaller: what is left of it is rounding.
      found.converged = !goal.allowed_error && tolerance < goal.residual && !problem.hessian.exhausted() &&
                        std::max(found.projected_gradient, found.equality) <= goal.residual && believed(true);
      return found;
    }
    if (!goal.allowed_error || tolerance <= limits::Every::finest) {
      found.converged = believed(tolerance <= limits::Every::rounding);
      if (found.converged || tolerance <= limits::Every::rounding) return found;
      tolerance *= Limits::fall_of_doubtful;
    } else {
      const double allowed = goal.allowed_error(found.x, found.nu);
      if (found.error <= allowed && fits(found, goal)) return found;
      tolerance = std::max(limits::Every::finest, tolerance * std::clamp(Limits::below_allowed * allowed / found.error,
                                                                         Limits::most_fall, Limits::least_fall));
    }
    start = std::move(found);
  }
}

std::unique_ptr<Solver> make_smalse(const Programme& programme, const Means& means)
{
  return std::make_unique<SmalseSolver>(programme, means.preconditioner);
}

}  // namespace mortise::qp
