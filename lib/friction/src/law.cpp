#include "friction/law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortise::friction {

std::vector<double> slip_bounds(const feti::DualProblem& problem, const std::vector<Law>& laws, const Vector* lambda)
{
  const auto& points = problem.constraints().contacts.nodes;
  std::vector<double> radii(problem.set().discs().size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    if (rows.disc < 0) continue;
    const Law& law = laws[static_cast<std::size_t>(points[i].contact)];
    double& radius = radii[static_cast<std::size_t>(rows.disc)];
    if (law.kind == Law::Kind::tresca) radius = problem.jump().multiplier(rows.normal, law.value * points[i].area);
    if (law.kind == Law::Kind::coulomb)
      radius = lambda ? law.value * std::max(view(*lambda)[rows.normal], 0.0) : std::numeric_limits<double>::infinity();
  }
  return radii;
}

std::vector<double> coefficients(const feti::DualProblem& problem, const std::vector<Law>& laws)
{
  std::vector<double> result(problem.set().discs().size(), 0.0);
  const auto& points = problem.constraints().contacts.nodes;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const Law& law = laws[static_cast<std::size_t>(points[i].contact)];
        law.kind == Law::Kind::coulomb && problem.node_rows()[i].disc >= 0)
      result[static_cast<std::size_t>(problem.node_rows()[i].disc)] = law.value;
  return result;
}

double relative_change(const std::vector<double>& next, const std::vector<double>& now, double least, const Communicator& comm)
{
  std::vector<double> squares(2, 0.0);  // of the difference, of the bounds
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (std::isinf(next[i])) continue;
    if (!std::isinf(now[i])) squares[0] += (next[i] - now[i]) * (next[i] - now[i]);
    squares[1] += next[i] * next[i];
  }
  comm.sum_in_place(squares);
  const double size = std::max(std::sqrt(squares[1]), least);
  return size > 0 ? std::sqrt(squares[0]) / size : 0;
}

}  // namespace mortise::friction
