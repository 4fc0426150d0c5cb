#include "friction/law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortise::friction {

namespace {

constexpr double nothing_part = 1e-10;  // of the bounds of a group, over those of the largest, below which they are none

}  // namespace

std::vector<double> slip_bounds(const feti::DualProblem& problem, const std::vector<Law>& laws, const Vector* lambda)
{
  const auto& points = problem.constraints().contacts.nodes;
  const Eigen::VectorXd forces = lambda ? problem.forces(*lambda) : Eigen::VectorXd();
  std::vector<double> bounds(problem.set().discs().size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    if (rows.disc < 0) continue;
    const Law& law = laws[static_cast<std::size_t>(points[i].contact)];
    double& bound = bounds[static_cast<std::size_t>(rows.disc)];
    if (law.kind == Law::Kind::tresca) bound = law.value * points[i].area;
    if (law.kind == Law::Kind::coulomb)
      bound = lambda ? law.value * std::max(forces[rows.normal], 0.0) : std::numeric_limits<double>::infinity();
  }
  return bounds;
}

bool any_coulomb(const std::vector<Law>& laws)
{
  return std::any_of(laws.begin(), laws.end(), [](const Law& law) { return law.kind == Law::Kind::coulomb; });
}

qp::FeasibleSet with_coefficients(const feti::DualProblem& problem, const std::vector<Law>& laws)
{
  std::vector<double> coefficients(problem.set().discs().size(), 0.0);
  const auto& points = problem.constraints().contacts.nodes;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const Law& law = laws[static_cast<std::size_t>(points[i].contact)];
        law.kind == Law::Kind::coulomb && problem.node_rows()[i].disc >= 0)
      coefficients[static_cast<std::size_t>(problem.node_rows()[i].disc)] = law.value;
  auto result = problem.set();
  result.set_coefficients(coefficients);
  return result;
}

double relative_change(const feti::DualProblem& problem, const std::vector<double>& next, const std::vector<double>& now,
                       double least)
{
  const auto& groups = problem.groups();
  const auto discs = problem.set().discs();
  std::vector<double> squares(2 * groups.of_body.size(), 0.0);  // of each group: of the difference, of the bounds
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (std::isinf(next[i])) continue;
    const auto group = 2 * static_cast<std::size_t>(std::max(groups.of_row[static_cast<std::size_t>(discs[i].index[0])], 0));
    if (!std::isinf(now[i])) squares[group] += (next[i] - now[i]) * (next[i] - now[i]);
    squares[group + 1] += next[i] * next[i];
  }
  problem.communicator().sum_in_place(squares);
  double largest = 0, change = 0;
  for (std::size_t g = 1; g < squares.size(); g += 2) largest = std::max(largest, squares[g]);
  least = std::max(least, nothing_part * std::sqrt(largest));
  for (std::size_t g = 0; g < squares.size(); g += 2) {
    const double size = std::max(std::sqrt(squares[g + 1]), least);
    if (size > 0) change = std::max(change, std::sqrt(squares[g]) / size);
  }
  return change;
}

}  // namespace mortise::friction
