#include "feti/means.hpp"

#include <memory>
#include <utility>

#include "feti/explicit_problem.hpp"

namespace mortise::feti {

qp::Means means_of(const DualProblem& problem, qp::Budget& budget)
{
  const auto make_explicit = [&problem] {
    const auto matrices = std::make_shared<ExplicitProblem>(problem);
    const auto solve = [matrices] {
      auto found = matrices->solve();
      return qp::ExplicitProgramme::Point{std::move(found.x), std::move(found.nu), found.converged};
    };
    return qp::ExplicitProgramme{matrices, solve};
  };
  return {budget, problem.preconditioner(), make_explicit};
}

}  // namespace mortise::feti
