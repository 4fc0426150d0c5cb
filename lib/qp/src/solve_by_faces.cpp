// The row `face_newton` of the table of solvers: face Newton, alone with a slip law and with SMALSE-M behind it where radii are
// given.
#include <cmath>
#include <utility>

#include "make_solvers.hpp"
#include "qp/face_newton.hpp"

namespace mortise::qp {

namespace {

// Updates radii between two active sets.
class FollowedRadii {
 public:
  // Those of the law at x, or those to begin with if there is none.
  FollowedRadii(const SlipLaw& law, const Vector* x, const Communicator& comm)
      : law_(law), comm_(comm), now_(law.radii(x)), before_(now_)
  {
    law_.set.set_radii(now_);
  }
  SlipBoundUpdate slip_bound_update()
  {
    return {[this](const Vector& x, bool apply) { return update(x, apply); }, [this] { retreat(); }, law_.cautious};
  }

 private:
  double update(const Vector& x, bool apply)
  {
    auto wanted = law_.radii(&x);
    double square = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] != now_[i]) square += (wanted[i] - now_[i]) * (wanted[i] - now_[i]);  // infinite while a point sticks anyway
    if (apply) {
      before_ = std::exchange(now_, std::move(wanted));
      law_.set.set_radii(now_);
    }
    return std::sqrt(comm_.sum(square));
  }
  void retreat()
  {
    now_ = half_way_back(std::move(now_), before_);
    law_.set.set_radii(now_);
  }

  const SlipLaw& law_;
  const Communicator& comm_;
  std::vector<double> now_, before_;
};

class FaceSolver : public Solver {
 public:
  FaceSolver(ActiveSetPreconditioner* inverse, const Problem& problem, const Means& means)
      : problem_(problem), means_(means), inverse_(inverse), newton_(problem, inverse)
  {
  }

  void begin(std::optional<Solution>& /*start*/, Goal& /*goal*/, const Observer& /*observer*/) override { steadier_ = false; }

  Solution solve(const std::optional<Solution>& start, const Goal& goal, const Observer& observer) override
  {
    Solution found = newton_.solve(start, goal, nullptr, observer);
    // Active sets that rounding has spoilt (stiffnesses that differ by 1e12) prove nothing; the other algorithm needs none.
    if (!found.feasible && !found.empty) found = smalse_to_goal(problem_, std::nullopt, goal, means_.preconditioner, observer);
    if (!found.feasible || found.converged || !means_.budget.may_change()) return found;
    // It crawls where bodies are soft and slender: the slower, steadier one.
    if (!std::exchange(steadier_, true)) means_.budget.change_algorithm();
    Solution next = smalse_to_goal(problem_, found, goal, means_.preconditioner, observer);
    next.outer_iterations += found.outer_iterations;
    next.preconditionings += found.preconditionings;
    return next;
  }

  std::optional<Solution> solve(const SlipLaw& law, const std::optional<Solution>& start, const Goal& goal,
                                const Observer& observer) override
  {
    if (!start) return follow(law, nullptr, start, goal, observer);
    Solution found = follow(law, &start->x, start, goal, observer);
    if (found.feasible) return found;
    // Radii of the solution before may leave no feasible point: then those to begin with.
    Solution next = follow(law, nullptr, start, goal, observer);
    next.outer_iterations += found.outer_iterations;
    next.preconditionings += found.preconditionings;
    return next;
  }

  ActiveSetPreconditioner* preconditioner() override { return inverse_; }

 private:
  Solution follow(const SlipLaw& law, const Vector* at, const std::optional<Solution>& start, const Goal& goal,
                  const Observer& observer)
  {
    FollowedRadii radii(law, at, problem_.equality.communicator());
    const SlipBoundUpdate slip_bound_update = radii.slip_bound_update();
    return newton_.solve(start, goal, &slip_bound_update, observer);
  }

  const Problem& problem_;
  Means means_;
  ActiveSetPreconditioner* inverse_;
  FaceNewton newton_;
  bool steadier_ = false;  // SMALSE-M has taken over, in these solves
};

}  // namespace

std::unique_ptr<Solver> face_newton_with(ActiveSetPreconditioner* inverse, const Problem& problem, const Means& means)
{
  return std::make_unique<FaceSolver>(inverse, problem, means);
}

std::unique_ptr<Solver> make_face_newton(const Problem& problem, const Means& means)
{
  return face_newton_with(means.preconditioner, problem, means);
}

}  // namespace mortise::qp
