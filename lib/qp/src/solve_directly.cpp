// The row `direct` of the table of solvers: an exact solution by matrices, from which face Newton starts with A^-1 as its
// preconditioner. It needs no more than the products that show that the start is one.
#include "make_solvers.hpp"

namespace mortise::qp {

namespace {

constexpr double rounding_of_direct = 1e-4;  // of the energy norm: error that a direct solution may leave

class DirectSolver : public Solver {
 public:
  DirectSolver(const Problem& problem, const Means& means)
      : problem_(problem), matrices_(means.make_explicit()), faces_(face_newton_with(matrices_.inverse.get(), problem, means))
  {
  }

  void begin(std::optional<Solution>& start, Goal& goal, const Observer& observer) override
  {
    faces_->begin(start, goal, observer);
    if (observer) observer({"direct", 0, problem_.hessian.count()});
    const auto found = matrices_.solve();
    if (found.converged && goal.allowed_error) goal.exact = rounding_of_direct;
    Solution solution(found.x, found.x, found.nu);
    if (start) solution.hessian_norm = start->hessian_norm;
    start = std::move(solution);
  }
  Solution solve(const std::optional<Solution>& start, const Goal& goal, const Observer& observer) override
  {
    return faces_->solve(start, goal, observer);
  }
  std::optional<Solution> solve(const SlipLaw& law, const std::optional<Solution>& start, const Goal& goal,
                                const Observer& observer) override
  {
    return faces_->solve(law, start, goal, observer);
  }
  ActiveSetPreconditioner* preconditioner() override { return matrices_.inverse.get(); }

 private:
  const Problem& problem_;
  ExplicitProgramme matrices_;
  std::unique_ptr<Solver> faces_;
};

}  // namespace

std::unique_ptr<Solver> make_direct(const Problem& problem, const Means& means)
{
  return std::make_unique<DirectSolver>(problem, means);
}

}  // namespace mortise::qp
