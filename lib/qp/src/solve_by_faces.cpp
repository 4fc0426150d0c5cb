// The row `face_newton` of the table of solvers: face Newton, alone with a slip law and with SMALSE-M behind it where radii are
// given.
#include <utility>

#include "make_solvers.hpp"
#include "qp/face_newton.hpp"

namespace mortise::qp {

namespace {

class FaceSolver : public Solver {
 public:
  FaceSolver(ActiveSetPreconditioner* inverse, const Programme& programme, const Means& means)
      : programme_(programme), means_(means), inverse_(inverse), newton_(programme, inverse)
  {
  }

  Foreknown begin(const RightHandSide& /*right*/, std::span<const double> /*radii*/, std::optional<Solution>& /*start*/,
                  Goal& /*goal*/, const Observer& /*observer*/, const Solution* /*suggested*/) override
  {
    steadier_ = false;
    return {};
  }

  Solution solve(const RightHandSide& right, std::span<const double> radii, const std::optional<Solution>& start,
                 const Goal& goal, const Observer& observer, Foreknown* /*known*/) override
  {
    const FeasibleSet set = programme_.set.with_radii(radii);
    const Problem problem(programme_, right, set);
    Solution found = newton_.solve(right, radii, nullptr, start, goal, observer);
    // Active sets that rounding has spoilt (stiffnesses that differ by 1e12) prove nothing; the other algorithm needs none.
    if (!found.feasible && !found.empty) found = smalse_to_goal(problem, std::nullopt, goal, means_.preconditioner, observer);
    if (!found.feasible || found.converged || !means_.budget.may_change()) return found;
    // It crawls where bodies are soft and slender: the slower, steadier one.
    if (!std::exchange(steadier_, true)) means_.budget.change_algorithm();
    Solution next = smalse_to_goal(problem, found, goal, means_.preconditioner, observer);
    next.outer_iterations += found.outer_iterations;
    next.preconditionings += found.preconditionings;
    return next;
  }

  std::optional<Solution> solve(const RightHandSide& right, const SlipLaw& law, const std::optional<Solution>& start,
                                const Goal& goal, const Observer& observer, Foreknown* /*known*/) override
  {
    if (!start) return newton_.solve(right, law.radii(nullptr), &law, start, goal, observer);
    Solution found = newton_.solve(right, law.radii(&start->x), &law, start, goal, observer);
    if (found.feasible) return found;
    // Radii of the solution before may leave no feasible point: then those to begin with.
    Solution next = newton_.solve(right, law.radii(nullptr), &law, start, goal, observer);
    next.outer_iterations += found.outer_iterations;
    next.preconditionings += found.preconditionings;
    return next;
  }

  ActiveSetPreconditioner* preconditioner() override { return inverse_; }

 private:
  Programme programme_;
  Means means_;
  ActiveSetPreconditioner* inverse_;
  FaceNewton newton_;
  bool steadier_ = false;  // SMALSE-M has taken over, in these solves
};

}  // namespace

std::unique_ptr<Solver> face_newton_with(ActiveSetPreconditioner* inverse, const Programme& programme, const Means& means)
{
  return std::make_unique<FaceSolver>(inverse, programme, means);
}

std::unique_ptr<Solver> make_face_newton(const Programme& programme, const Means& means)
{
  return face_newton_with(means.preconditioner, programme, means);
}

}  // namespace mortise::qp
