#include "feti/means.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "feti/explicit_problem.hpp"
#include "feti/sparse_problem.hpp"

namespace mortise::feti {

namespace {

// Inaccuracy of a subdomain from which on F as a matrix, large in soft motions, has nothing left of what stiff cells do.
constexpr double lost_in_dense = 1e-5;

qp::ExplicitProgramme sparse_programme(const DualProblem& problem)
{
  using Point = qp::ExplicitProgramme::Point;
  const auto matrices = std::make_shared<SparseProblem>(problem);
  const auto go_on = [matrices](const Vector& linear, const Eigen::VectorXd& e, const qp::FeasibleSet& set, const Point& near) {
    return matrices->go_on(linear, e, set, near.x);
  };
  return {matrices, [matrices](const qp::FeasibleSet& set) { return matrices->solve(set); }, go_on, true};
}

// The largest of the subdomains. Collective.
double inaccuracy(const DualProblem& problem)
{
  double result = 0;
  for (const auto& subdomain : problem.clusters().subdomains()) result = std::max(result, subdomain->inaccuracy());
  return problem.communicator().max(result);
}

}  // namespace

qp::Means means_of(DualProblem& problem, qp::Budget& budget)
{
  const auto make_explicit = [&problem] {
    problem.be_exact();
    const auto turn = SparseProblem::turn(problem);
    const double lost = inaccuracy(problem);
    if (turn == SparseProblem::Turn::first || (turn == SparseProblem::Turn::second && lost > lost_in_dense))
      return sparse_programme(problem);
    const auto matrices = std::make_shared<ExplicitProblem>(problem);
    using Point = qp::ExplicitProgramme::Point;
    qp::ExplicitProgramme programme{matrices, [matrices](const qp::FeasibleSet& set) { return matrices->solve(set); }};
    programme.go_on = [matrices](const Vector& linear, const Eigen::VectorXd& e, const qp::FeasibleSet& set, const Point& near) {
      return matrices->solve(linear, e, set, &near);
    };
    programme.differs = matrices->differs();
    programme.doubtful = lost > inaccurate;
    if (turn == SparseProblem::Turn::second) programme.instead = [&problem] { return sparse_programme(problem); };
    return programme;
  };
  return {budget, problem.preconditioner(), make_explicit};
}

}  // namespace mortise::feti
