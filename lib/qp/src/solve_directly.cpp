// The row `direct` of the table of solvers: an exact solution by matrices, from which face Newton starts with A^-1 as its
// preconditioner. It needs no more than the products that show that the start is one.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/lazy.hpp"
#include "make_solvers.hpp"

namespace mortise::qp {

namespace {

class DirectSolver : public Solver {
 public:
  DirectSolver(const Programme& programme, const Means& means)
      : programme_(programme),
        means_(means),
        matrices_(means.make_explicit()),
        better_inverse_(matrices_.rough_products ? matrices_.inverse : nullptr),
        has_others_(static_cast<bool>(matrices_.instead)),
        others_(matrices_.instead),
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
    if (!accepted) accepted = improve_with_all(problem, found, goal);
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
    const auto by_faces = [&](const std::optional<Solution>& from) {
      return std::optional(faces_->solve(right, radii, from, within_reach(goal, known), observer, nullptr));
    };
    return *solved_by(
        by_faces, [&](const Vector&) { return std::vector<double>(radii.begin(), radii.end()); }, right, start, goal, known);
  }
  std::optional<Solution> solve(const RightHandSide& right, const SlipLaw& law, const std::optional<Solution>& start,
                                const Goal& goal, const Observer& observer, Foreknown* known) override
  {
    if (known && known->answer) {
      auto answer = std::exchange(known->answer, {});
      if (!answer->slides) answer->radii = law.radii(&answer->x);
      return answer;
    }
    const auto by_faces = [&](const std::optional<Solution>& from) {
      return faces_->solve(right, law, from, within_reach(goal, known), observer, nullptr);
    };
    return solved_by(
        by_faces, [&](const Vector& x) { return law.radii(&x); }, right, start, goal, known);
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
      if (auto accepted = improve(problem, found, goal).accepted) return {found, std::move(accepted)};
    if (found.converged && matrices_.instead_of_none) return {found};
    if (!has_others_) return {found};
    auto next = others_.get().solve(problem.right, problem.set);
    if (!next.converged) return {found};
    if (found.converged && !next.settled) return {found};
    take_others();
    return {next};
  }

  void take_others()
  {
    std::swap(matrices_, others_.get());
    faces_ = face_newton_with(matrices_.inverse.get(), programme_, means_);
  }

  // Where much is left that the matrices differ by, as dense ones of a soft film do between stiff bodies, with the other ones, if
  // they come nearer.
  std::optional<Solution> improve_with_all(const Problem& problem, ExplicitProgramme::Result& found, const Goal& goal)
  {
    auto [accepted, exact] = improve(problem, found, goal);
    if (accepted || exact || !found.reaction || !goal.energy_norm || matrices_.instead_of_none) return accepted;
    const double error = judge(problem, found).error;
    if (!(error > Limits::much * goal.energy_norm(found.x, found.nu)) || !has_others_) return {};
    auto next = others_.get().solve(problem.right, problem.set);
    if (!next.converged || !next.settled || !next.reaction) return {};
    take_others();
    accepted = improve(problem, next, goal).accepted;
    if (accepted || judge(problem, next).error < error)
      found = std::move(next);
    else
      take_others();
    return accepted;
  }

  // A residual that is asked for may be smaller than rounding of products lets it become. The error is then known all the same.
  static Goal within_reach(Goal goal, const Foreknown* known)
  {
    if (known && known->by_matrices && !goal.allowed_error && goal.energy_norm) goal.exact = Limits::makes_up_for_residual;
    return goal;
  }

  struct Improved {
    std::optional<Solution> accepted;  // if it can be judged and will do
    bool exact;                        // nothing is left that the matrices differ by
  };

  // Takes away what the matrices differ by.
  Improved improve(const Problem& problem, ExplicitProgramme::Result& found, const Goal& goal)
  {
    const bool exact = !matrices_.differs || correct(problem, found, goal);
    if (!matrices_.rough_products || !goal.allowed_error) return {{}, exact};
    return {judged(problem, found, goal), exact};
  }

  // By faces from `start`. Where products are too rough to show what the matrices found, it is judged in place of their last
  // point; where it will not do, the other matrices have their turn. `radii_at` a point.
  template <class Faces, class Radii>
  std::optional<Solution> solved_by(const Faces& by_faces, const Radii& radii_at, const RightHandSide& right,
                                    const std::optional<Solution>& start, const Goal& goal, Foreknown* known)
  {
    auto solution = by_faces(start);
    const auto will_do = [&] { return !solution || solution->converged || !known || !known->by_matrices; };
    const auto judge_matrices = [&] {
      if (!will_do()) take_judged(right, radii_at(known->by_matrices->x), goal, *known->by_matrices, *solution);
    };
    judge_matrices();
    if (will_do() || !goal.energy_norm || matrices_.instead_of_none || !has_others_) return solution;
    const FeasibleSet set = programme_.set.with_radii(radii_at(known->by_matrices->x));
    const Problem problem(programme_, right, set);
    auto next = others_.get().solve(right, set);
    if (!next.converged || !next.settled || !next.reaction) return solution;
    take_others();
    improve(problem, next, goal);
    std::optional<Solution> from(Solution(next.x, next.x, next.nu));
    from->hessian_norm = solution->hessian_norm;
    known->by_matrices = std::move(next);
    solution = by_faces(from);
    judge_matrices();
    return solution;
  }

  // In place of `solution`, if it will do.
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

  // A solution by the matrices, x with nu and s, solves the programme with b + d in place of b, d = A x - b + G'nu - s for the nu
  // that leaves least, and so is off by no more than d in the norm of A^-1. Where that is nothing, it is the solution, though
  // products with A may be too rough for what states follow from: of a thin body they turn figures that x does not have into
  // motions that open contact. One product.
  Solution judge(const Problem& problem, const ExplicitProgramme::Result& found)
  {
    Solution result(found.x, found.x, found.nu);
    problem.hessian.gradient(found.x, problem.right, result.gradient);
    Vector defect(result.gradient, Teuchos::Copy);
    defect.update(-1, *found.reaction, 1);
    problem.equality.add_transpose(1, found.nu, defect);
    problem.equality.project(defect);
    result.error = std::sqrt(std::max(energy(defect, problem.equality), 0.0));
    result.projected_gradient = defect.norm2() / relative_size(problem, limits::Every::finest);
    const auto& equality = problem.equality;
    if (const double forces = found.x.norm2(); equality.size() > 0 && forces > 0)
      result.equality = equality.norm(problem.right.e - equality.apply(found.x)) / forces;
    result.outer_iterations = 1;
    return result;
  }

  // d'A^-1 d; of slender bodies about the least of d + G'nu, for what motions do in a defect they may do to all its rows. That is
  // made anew from what is left of d: a difference of two energies would have none of its figures.
  double energy(const Vector& defect, const EqualityConstraint& equality) const
  {
    auto& inverse = better_inverse_ ? *better_inverse_ : *matrices_.inverse;
    Vector error(defect.getMap());
    inverse.apply(defect, error);
    const Eigen::Index motions = equality.size();
    if (motions == 0 || motions > Limits::most_motions || !better_inverse_) return defect.dot(error);
    Eigen::MatrixXd work(motions, motions);
    for (Eigen::Index i = 0; i < motions; ++i) {
      Vector push(defect.getMap()), answer(defect.getMap());
      equality.add_transpose(1, Eigen::VectorXd::Unit(motions, i), push);
      inverse.apply(push, answer);
      work.col(i) = equality.apply(answer);
    }
    const Eigen::LDLT<Eigen::MatrixXd> factor(work);
    Vector left(defect, Teuchos::Copy);
    for (int step = 0; step < Limits::steps_to_least_energy; ++step) {
      equality.add_transpose(-1, factor.solve(equality.apply(error)), left);
      inverse.apply(left, error);
    }
    return left.dot(error);
  }

  // The same if it will do.
  std::optional<Solution> judged(const Problem& problem, const ExplicitProgramme::Result& found, const Goal& goal)
  {
    if (!found.reaction || !(relative_size(problem, limits::Every::finest) > 0)) return {};
    Solution result = judge(problem, found);
    const double energy_norm = goal.energy_norm ? goal.energy_norm(found.x, found.nu) : norm_of(found.x, problem, result);
    result.converged = result.error <= allowed_error(result, energy_norm, goal) && obeys(problem, found.x) &&
                       (!goal.incompatibility || goal.incompatibility(found.x, found.nu) <= limits::Every::nearly_compatible);
    if (!result.converged) return {};
    return result;
  }

  // In the norm of A, from A x - b.
  static double norm_of(const Vector& x, const Problem& problem, const Solution& solution)
  {
    return std::sqrt(std::max(x.dot(solution.gradient) + x.dot(problem.right.b), 0.0));
  }

  // What the error of a solution by the matrices may be, from its residual.
  static double allowed_error(const Solution& solution, double energy_norm, const Goal& goal)
  {
    if (goal.allowed_error)
      return solution.projected_gradient > limits::Every::largest_residual
                 ? 0
                 : std::max(Limits::rounding_of_direct * energy_norm, goal.allowed_error(solution.x, solution.nu));
    return solution.projected_gradient <= limits::Every::largest_residual ? Limits::makes_up_for_any_residual * energy_norm : 0;
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
  // (1978)]. One product each. Whether what is left is what was asked for.
  bool correct(const Problem& problem, ExplicitProgramme::Result& found, const Goal& goal)
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
      problem.hessian.gradient(found.x, problem.right, defect);
      defect.update(-1, *found.reaction, 1);
      equality.add_transpose(1, found.nu, defect);
      Vector felt(defect, Teuchos::Copy);
      equality.project(felt);
      const double size = felt.norm2();
      const bool nearer = size < Limits::better * least;
      if (size < least) {
        least = size;
        best = found;
      }
      if (!nearer || step == Limits::most_corrections) break;
      if (size <= enough && is_nothing(felt, found, goal) && fits_together(found, goal)) return true;
      linear.update(-1, defect, 1);
      right_side += lacking;
      auto next = matrices_.go_on(problem.right, linear, right_side, problem.set, found);
      if (!next.converged) break;
      found = std::move(next);
    }
    if (best) found = std::move(*best);
    return false;
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
  // Of the first matrices, where others may take their place and have an A^-1 that does not feel what they have lost.
  const std::shared_ptr<ActiveSetPreconditioner> better_inverse_;
  const bool has_others_;
  const Lazy<ExplicitProgramme> others_;  // made where they are needed, if there are any
  std::unique_ptr<Solver> faces_;
};

}  // namespace

std::unique_ptr<Solver> make_direct(const Programme& programme, const Means& means)
{
  return std::make_unique<DirectSolver>(programme, means);
}

}  // namespace mortise::qp
