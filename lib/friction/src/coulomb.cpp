#include "friction/coulomb.hpp"

#include <tuple>
#include <utility>

#include "coulomb_search.hpp"
#include "equilibrium.hpp"

namespace mortise::friction {

CoulombSearch::CoulombSearch(const CoulombProblem& problem, const CoulombMeans& means, const Observer& observer)
    : problem_(problem),
      means_(means),
      watch_([this, &observer](const qp::Progress& progress) { observer(step_, change_, progress); }),
      radii_(radii_at(nullptr)),
      previous_radii_(radii_),
      at_work_(radii_),
      solution_(problem.start)
{
}

// The radii of discs by the law, with the forces of these multipliers or before any are known.
std::vector<double> CoulombSearch::radii_at(const Vector* lambda) const
{
  return problem_.dual.radii(slip_bounds(problem_.dual, problem_.laws, lambda));
}

qp::SlipLaw CoulombSearch::slip_law(bool cautious) const
{
  return {[this](const Vector* x) { return radii_at(x); }, cautious};
}

void CoulombSearch::count(const qp::Solution& found)
{
  outer_ += found.outer_iterations;
  preconditionings_ += found.preconditionings;
}

// ||wanted - now|| / ||wanted|| of slip bounds at a solution, but for what rounding makes of no force at all: of multipliers of
// the size ||b|| / ||A||.
double CoulombSearch::change_of_bounds(const std::vector<double>& wanted, const std::vector<double>& now,
                                       const qp::Solution& at) const
{
  constexpr double rounding = 1e-10;
  const double least = at.hessian_norm > 0 ? rounding * problem_.right.b.norm2() / at.hessian_norm : 0;
  return relative_change(problem_.dual, wanted, now, least);
}

// Of bounds and forces that were found together. Where the error decides, what the bounds would still change counts in it.
bool CoulombSearch::obeys_law(qp::Solution& found, const std::vector<double>& radii, double change)
{
  return found.converged && (problem_.goal.allowed_error || change <= problem_.options.tolerance) &&
         balances(problem_.dual, problem_.omega, radii, found.x) && judge(found);
}

void CoulombSearch::follow_law()
{
  const qp::SlipLaw law = slip_law(false);
  const auto solve = [&] { return means_.algorithm.solve(problem_.right, law, solution_, problem_.goal, watch_, means_.known); };
  step_ = 1;
  auto found = solve();
  if (found && found->slides) {
    refuse_if_sliding(problem_.dual, problem_.omega, problem_.laws, found->x);
    found = solve();
  }
  if (!found) {
    step_ = 0;
    return;
  }
  count(*found);
  at_work_ = found->radii;
  if (!found->feasible) return;
  radii_ = radii_at(&found->x);
  change_ = change_of_bounds(radii_, at_work_, *found);
  converged_ = obeys_law(*found, radii_, change_);
  solution_ = std::move(found);
  solved_ = true;
}

void CoulombSearch::follow_cautiously()
{
  if (converged_ || !means_.budget.left()) return;
  means_.budget.change_algorithm();
  auto found = means_.algorithm.solve(problem_.right, slip_law(true), problem_.before, problem_.goal, watch_, means_.known);
  if (!found) return;
  count(*found);
  if (!found->feasible) return;
  auto radii = radii_at(&found->x);
  const double change = change_of_bounds(radii, found->radii, *found);
  const auto before = std::pair(std::exchange(at_work_, found->radii), judged_);
  if (!obeys_law(*found, radii, change)) {
    std::tie(at_work_, judged_) = before;
    return;
  }
  radii_ = std::move(radii);
  change_ = change;
  solution_ = found;
  solved_ = converged_ = true;
}

bool CoulombSearch::judge(qp::Solution& solution)
{
  judge_by_law(problem_.dual, problem_.omega.with_radii(at_work_), problem_.laws, means_.hessian, solution);
  judged_ = true;
  return !problem_.goal.allowed_error || !(solution.error > Limits::slack * problem_.goal.allowed_error(solution.x, solution.nu));
}

CoulombSolution CoulombSearch::solve(const CoulombWays& ways)
{
  const auto& hessian = means_.hessian;
  follow_law();
  if (!solved_ || ways.fixed_point) fixed_point();  // a few products each, from what A^-1 leads on from
  const bool spent = hessian.exhausted();
  std::string limit;
  if (spent)
    limit = means_.budget.reason();
  else if (step_ >= problem_.options.max_steps)
    limit = "friction_loop.max_steps";
  if (ways.cautiously) follow_cautiously();
  if (solved_ && (converged_ || !(spent || hessian.exhausted())) && !judged_) judge(*solution_);
  return {{.solution = *solution_,
           .steps = step_,
           .change = change_,
           .converged = converged_ && solution_->converged,
           .limit = std::move(limit),
           .preconditionings = preconditionings_,
           .outer_iterations = outer_},
          at_work_};
}

CoulombSolution solve_coulomb(const CoulombProblem& problem, const CoulombMeans& means, const CoulombWays& ways,
                              const Observer& observer)
{
  return CoulombSearch(problem, means, observer).solve(ways);
}

}  // namespace mortise::friction
