// The right-hand sides of contact rows as an equilibrium has them.
#pragma once

#include <vector>

#include "feti/dual_problem.hpp"

namespace mortise::post {

// g of this rank's contact rows, with what pretension sections are drawn together.
inline std::vector<double> contact_bounds(const feti::DualProblem& problem, const Eigen::VectorXd& nu)
{
  auto result = problem.constraints().contacts.rows.bound;
  const auto shortenings = problem.shortenings(nu);
  for (std::size_t c = 0; c < shortenings.size(); ++c)
    for (const auto& [row, part] : problem.constraints().pretension_sections[c].rows) result[row] += part * shortenings[c];
  return result;
}

}  // namespace mortise::post
