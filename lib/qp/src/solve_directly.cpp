// The row `direct` of the table of solvers: an exact solution by matrices, from which face Newton starts with A^-1 as its
// preconditioner. It needs no more than the products that show that the start is one.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "make_solvers.hpp"

namespace mortise::qp {

namespace {

class DirectSolver : public Solver {
 public:
  DirectSolver(const Programme& programme, const Means& means)
      : programme_(programme),
        means_(means),
        matrices_(means.make_explicit()),
        faces_(face_newton_with(matrices_.inverse.get(), programme, means))
  {
  }

  Foreknown begin(const RightHandSide& right, std::span<const double> radii, std::optional<Solution>& start, Goal& goal,
                  const Observer& observer, const Solution* suggested) override
  {
    if (observer) observer({"direct", 0, programme_.hessian.count()});
    const FeasibleSet set = programme_.set.with_radii(radii);
    const Problem problem(programme_, right, set);
    auto [found, accepted] = solve_with_matrices(problem, start, suggested, goal);
    faces_->begin(right, radii, start, goal, observer, nullptr);
    Foreknown known;
    if (found.slides) {
      known.answer.emplace(found.x, found.x, found.nu);
      known.answer->feasible = false;
      known.answer->slides = true;
      known.answer->radii = set.radii();
    }
    if (!found.converged) return known;  // a guess of states that are none leads faces astray
    if (!accepted) accepted = improve(problem, found, goal);
    if (goal.allowed_error) goal.exact = Limits::rounding_of_direct;
    if (found.reaction) known.by_matrices = found;
    Solution solution(found.x, found.x, found.nu);
    if (start) solution.hessian_norm = start->hessian_norm;
    if (accepted) {
      accepted->hessian_norm = solution.hessian_norm;
      known.answer = std::move(accepted);
    }
    start = std::move(solution);
    return known;
  }
  Solution solve(const RightHandSide& right, std::span<const double> radii, const std::optional<Solution>& start,
                 const Goal& goal, const Observer& observer, Foreknown* known) override
  {
    if (known && known->answer && !known->answer->slides) {
      auto answer = *std::exchange(known->answer, {});
      answer.radii.assign(radii.begin(), radii.end());
      return answer;
    }
    auto solution = faces_->solve(right, radii, start, within_reach(goal, known), observer, nullptr);
    if (!solution.converged && known && known->by_matrices) take_judged(right, radii, goal, *known->by_matrices, solution);
    return solution;
  }
  std::optional<Solution> solve(const RightHandSide& right, const SlipLaw& law, const std::optional<Solution>& start,
                                const Goal& goal, const Observer& observer, Foreknown* known) override
  {
    if (known && known->answer) {
      auto answer = std::exchange(known->answer, {});
      if (!answer->slides) answer->radii = law.radii(&answer->x);
      return answer;
    }
    auto solution = faces_->solve(right, law, start, within_reach(goal, known), observer, nullptr);
    if (solution && !solution->converged && known && known->by_matrices)
      take_judged(right, law.radii(&known->by_matrices->x), goal, *known->by_matrices, *solution);
    return solution;
  }
  ActiveSetPreconditioner* preconditioner() override { return matrices_.inverse.get(); }

 private:
  using Limits = limits::Direct;

  struct ByMatrices {
    ExplicitProgramme::Result found;
    std::optional<Solution> accepted = {};  // the same, if it is judged and will do
  };

  // From the states of the problem before or from those that are suggested, if there are any; else from anywhere with the
  // matrices that served last, or the other ones, if there are any, where these do not tell the states of all constraints.
  ByMatrices solve_with_matrices(const Problem& problem, const std::optional<Solution>& before, const Solution* suggested,
                                 const Goal& goal)
  {
    if (before && matrices_.go_on) {
      Vector reaction(before->gradient, Teuchos::Copy);
      problem.equality.add_transpose(1, before->nu, reaction);
      const auto& right = problem.right;
      auto next = matrices_.go_on(right, right.b, right.e, problem.set, {before->x, before->nu, true, reaction});
      if (next.converged && next.settled) return {next};
    }
    if (suggested && matrices_.go_on) {
      const auto& right = problem.right;
      auto next =
          matrices_.go_on(right, right.b, right.e, problem.set, {suggested->x, suggested->nu, false, suggested->gradient});
      if (next.converged && next.settled) return {next};
    }
    auto found = matrices_.solve(problem.right, problem.set);
    if ((found.converged && found.settled) || found.slides) return {found};
    if (found.converged && matrices_.rough_products)
      if (auto accepted = improve(problem, found, goal)) return {found, std::move(accepted)};
    if (found.converged && matrices_.instead_of_none) return {found};
    if (matrices_.instead) others_ = std::exchange(matrices_.instead, {})();
    if (!others_) return {found};
    auto next = others_->solve(problem.right, problem.set);
    if (!next.converged) return {found};
    if (found.converged && !next.settled) return {found};
    std::swap(matrices_, *others_);
    faces_ = face_newton_with(matrices_.inverse.get(), programme_, means_);
    return {next};
  }

  // A residual that is asked for may be smaller than rounding of products lets it become. The error is then known all the same.
  static Goal within_reach(Goal goal, const Foreknown* known)
  {
    if (known && known->by_matrices && !goal.allowed_error && goal.energy_norm) goal.exact = Limits::makes_up_for_residual;
    return goal;
  }

  // Takes away what the matrices differ by. Returns the solution if it can be judged and will do.
  std::optional<Solution> improve(const Problem& problem, ExplicitProgramme::Result& found, const Goal& goal)
  {
    if (matrices_.differs) correct(problem, found, goal);
    if (!matrices_.rough_products || !goal.allowed_error) return {};
    return judged(problem, found, goal);
  }

  // Where products are too rough to show what the matrices found, it is judged in place of `solution`.
  void take_judged(const RightHandSide& right, std::span<const double> radii, const Goal& goal,
                   const ExplicitProgramme::Result& found, Solution& solution)
  {
    const FeasibleSet set = programme_.set.with_radii(radii);
    auto other = judged(Problem(programme_, right, set), found, goal);
    if (!other) return;
    other->hessian_norm = solution.hessian_norm;
    other->radii.assign(radii.begin(), radii.end());
    solution = std::move(*other);
  }

  // A solution by the matrices, x with nu and s, solves the programme with b + d in place of b, d = A x - b + G'nu - s, and so is
  // off by no more than d in the norm of A^-1. Where that is nothing, it is the solution, though products with A may be too rough
  // for what states follow from: of a thin body they turn figures that x does not have into motions that open contact. One
  // product.
  std::optional<Solution> judged(const Problem& problem, const ExplicitProgramme::Result& found, const Goal& goal)
  {
    if (!found.reaction) return {};
    Solution result(found.x, found.x, found.nu);
    problem.hessian.apply(found.x, result.gradient);
    const double size_of_x = std::sqrt(std::max(result.gradient.dot(found.x), 0.0));
    result.gradient.update(-1, problem.right.b, 1);
    Vector defect(result.gradient, Teuchos::Copy), error(defect.getMap());
    defect.update(-1, *found.reaction, 1);
    problem.equality.add_transpose(1, found.nu, defect);
    matrices_.inverse->apply(defect, error);
    result.error = std::sqrt(std::max(defect.dot(error), 0.0));
    const double size = relative_size(problem, limits::Every::finest);
    if (!(size > 0)) return {};
    result.projected_gradient = defect.norm2() / size;
    const auto& equality = problem.equality;
    if (const double forces = found.x.norm2(); equality.size() > 0 && forces > 0)
      result.equality = equality.norm(problem.right.e - equality.apply(found.x)) / forces;
    result.outer_iterations = 1;
    const double energy_norm = goal.energy_norm ? goal.energy_norm(found.x, found.nu) : size_of_x;
    // What a residual may be, and an error, in its place.
    const double residual =
        goal.allowed_error ? limits::Every::largest_residual : std::max(goal.residual, Limits::rough_residual);
    const double allowed = goal.allowed_error ? Limits::rounding_of_direct : Limits::makes_up_for_residual;
    result.converged = result.error <= allowed * energy_norm && result.projected_gradient <= residual &&
                       obeys(problem, found.x) &&
                       (!goal.incompatibility || goal.incompatibility(found.x, found.nu) <= limits::Every::nearly_compatible);
    if (!result.converged) return {};
    return result;
  }

  // Whether x lies in Omega, with friction within its cones, and balances the loads.
  static bool obeys(const Problem& problem, const Vector& x)
  {
    Vector beyond(x, Teuchos::Copy);
    problem.set.with_cones().project(view(beyond));
    beyond.update(-1, x, 1);
    const auto& equality = problem.equality;
    const double lacking = equality.size() > 0 ? equality.norm(problem.right.e - equality.apply(x)) : 0;
    return std::hypot(beyond.norm2(), lacking) <= Limits::outside * x.norm2();
  }

  // With another matrix M in place of A a solution x leaves the defect A x - b + G'nu - s, s = M x - b + G'nu, which is (A - M)
  // x: less that, b gives the next one [Stetter, The defect correction principle and discretization methods, Numer. Math. 29
  // (1978)]. One product each.
  void correct(const Problem& problem, ExplicitProgramme::Result& found, const Goal& goal)
  {
    const auto& equality = problem.equality;
    const double enough =
        Limits::of_goal * std::min(goal.residual, Limits::asked_at_least) * relative_size(problem, goal.residual);
    Vector linear(problem.right.b, Teuchos::Copy), defect(linear.getMap());
    Eigen::VectorXd right_side = problem.right.e;
    std::optional<ExplicitProgramme::Result> best;
    double least = std::numeric_limits<double>::infinity();
    for (int step = 0; !problem.hessian.exhausted(); ++step) {
      const Eigen::VectorXd lacking = problem.right.e - equality.apply(found.x);
      equality.add_transpose(1, equality.solve(lacking), found.x);
      problem.hessian.apply(found.x, defect);
      defect.update(-1, problem.right.b, -1, *found.reaction, 1);
      equality.add_transpose(1, found.nu, defect);
      Vector felt(defect, Teuchos::Copy);
      equality.project(felt);
      const double size = felt.norm2();
      const bool nearer = size < Limits::better * least;
      if (size < least) {
        least = size;
        best = found;
      }
      if (!nearer || step == Limits::most_corrections ||
          (size <= enough && is_nothing(felt, found, goal) && fits_together(found, goal)))
        break;
      linear.update(-1, defect, 1);
      right_side += lacking;
      auto next = matrices_.go_on(problem.right, linear, right_side, problem.set, found);
      if (!next.converged) break;
      found = std::move(next);
    }
    if (best) found = std::move(*best);
  }

  // Whether a defect is one of displacements that take hardly any energy.
  bool is_nothing(const Vector& defect, const ExplicitProgramme::Result& found, const Goal& goal) const
  {
    if (!goal.energy_norm) return true;
    Vector error(defect.getMap());
    matrices_.inverse->apply(defect, error);
    return std::sqrt(std::max(defect.dot(error), 0.0)) <= Limits::of_energy * goal.energy_norm(found.x, found.nu);
  }

  // Energy feels little of what is soft, as plates are along themselves.
  static bool fits_together(const ExplicitProgramme::Result& found, const Goal& goal)
  {
    return !goal.incompatibility || goal.incompatibility(found.x, found.nu) <= limits::Every::compatible;
  }

  Programme programme_;
  Means means_;
  ExplicitProgramme matrices_;
  std::optional<ExplicitProgramme> others_;  // made where they were needed
  std::unique_ptr<Solver> faces_;
};

}  // namespace

std::unique_ptr<Solver> make_direct(const Programme& programme, const Means& means)
{
  return std::make_unique<DirectSolver>(programme, means);
}

}  // namespace mortise::qp
