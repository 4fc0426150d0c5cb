#include "friction/coulomb.hpp"

#include <utility>

#include "coulomb_search.hpp"
#include "equilibrium.hpp"

namespace mortise::friction {

CoulombSearch::CoulombSearch(const CoulombProblem& problem, const CoulombMeans& means, const Observer& observer)
    : problem_(problem),
      means_(means),
      watch_([this, &observer](const qp::Progress& progress) { observer(step_, change_, progress); }),
      at_work_(radii_at(nullptr))
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
bool CoulombSearch::obeys_law(Found& found, const std::vector<double>& radii, double change)
{
  const auto& solution = found.solution;
  return solution.converged && (problem_.goal.allowed_error || change <= problem_.options.tolerance) &&
         balances(problem_.dual, problem_.omega, radii, solution.x) && judge(found);
}

std::optional<CoulombSearch::Found> CoulombSearch::follow_law()
{
  const qp::SlipLaw law = slip_law(false);
  const auto solve = [&] {
    return means_.algorithm.solve(problem_.right, law, problem_.start, problem_.goal, watch_, means_.known);
  };
  step_ = 1;
  auto solution = solve();
  if (solution && solution->slides) {
    refuse_if_sliding(problem_.dual, problem_.omega, problem_.laws, solution->x);
    solution = solve();
  }
  if (!solution) {
    step_ = 0;
    return {};
  }
  count(*solution);
  at_work_ = solution->radii;
  if (!solution->feasible) return {};
  Found found{std::move(*solution)};
  const auto radii = radii_at(&found.solution.x);
  change_ = change_of_bounds(radii, at_work_, found.solution);
  found.converged = obeys_law(found, radii, change_);
  return found;
}

std::optional<CoulombSearch::Found> CoulombSearch::follow_cautiously()
{
  means_.budget.change_algorithm();
  auto solution = means_.algorithm.solve(problem_.right, slip_law(true), problem_.before, problem_.goal, watch_, means_.known);
  if (!solution) return {};
  count(*solution);
  if (!solution->feasible) return {};
  Found found{std::move(*solution)};
  const auto radii = radii_at(&found.solution.x);
  const double change = change_of_bounds(radii, found.solution.radii, found.solution);
  auto before = std::exchange(at_work_, found.solution.radii);
  found.converged = obeys_law(found, radii, change);
  if (!found.converged) {
    at_work_ = std::move(before);
    return {};
  }
  change_ = change;
  return found;
}

bool CoulombSearch::judge(Found& found)
{
  auto& solution = found.solution;
  judge_by_law(problem_.dual, problem_.omega.with_radii(at_work_), problem_.laws, means_.hessian, solution);
  found.judged = true;
  return !problem_.goal.allowed_error || !(solution.error > Limits::slack * problem_.goal.allowed_error(solution.x, solution.nu));
}

CoulombSolution CoulombSearch::solve(const CoulombWays& ways)
{
  const auto& hessian = means_.hessian;
  auto found = follow_law();
  if (!found || ways.fixed_point) found = fixed_point(std::move(found));  // a few products each, from what A^-1 leads on from
  const bool spent = hessian.exhausted();
  std::string limit;
  if (spent)
    limit = means_.budget.reason();
  else if (step_ >= problem_.options.max_steps)
    limit = "friction_loop.max_steps";
  if (ways.cautiously && !found->converged && means_.budget.left())
    if (auto better = follow_cautiously()) found = std::move(better);
  if ((found->converged || !(spent || hessian.exhausted())) && !found->judged) judge(*found);
  return {{.solution = found->solution,
           .steps = step_,
           .change = change_,
           .converged = found->converged && found->solution.converged,
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
