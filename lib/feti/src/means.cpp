#include "feti/means.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "feti/explicit_problem.hpp"
#include "feti/sparse_problem.hpp"

namespace mortise::feti {

namespace {

qp::ExplicitProgramme sparse_programme(const DualProblem& problem, bool slender)
{
  using Result = qp::ExplicitProgramme::Result;
  const auto matrices = std::make_shared<SparseProblem>(problem, slender);
  const auto solve = [matrices](const qp::RightHandSide& right, const qp::FeasibleSet& set) {
    return matrices->solve(right, set);
  };
  const auto go_on = [matrices](const qp::RightHandSide& right, const Vector& d, const Eigen::VectorXd& e,
                                const qp::FeasibleSet& set,
                                const Result& near) { return matrices->go_on(right, d, e, set, near); };
  return {matrices, solve, go_on, true, {}, slender};
}

qp::ExplicitProgramme dense_programme(const DualProblem& problem)
{
  using Result = qp::ExplicitProgramme::Result;
  const auto matrices = std::make_shared<ExplicitProblem>(problem);
  const auto solve = [matrices](const qp::RightHandSide& right, const qp::FeasibleSet& set) {
    return matrices->solve(right.b, right.e, set);
  };
  const auto go_on = [matrices](const qp::RightHandSide&, const Vector& d, const Eigen::VectorXd& e, const qp::FeasibleSet& set,
                                const Result& near) { return matrices->solve(d, e, set, &near); };
  return {matrices, solve, go_on, matrices->differs()};
}

// The largest of the subdomains. Collective.
double inaccuracy(const DualProblem& problem)
{
  double result = 0;
  for (const auto& subdomain : problem.clusters().subdomains()) result = std::max(result, subdomain->inaccuracy());
  return problem.communicator().max(result);
}

}  // namespace

qp::Means means_of(const DualProblem& problem, qp::Budget& budget)
{
  const auto make_explicit = [&problem] {
    const bool slender = inaccuracy(problem) > inaccurate;
    const auto turn = SparseProblem::turn(problem, slender);
    if (turn == SparseProblem::Turn::first) return sparse_programme(problem, slender);
    if (turn == SparseProblem::Turn::never) return dense_programme(problem);
    // F as a dense matrix is large in soft motions: little may be left in it of what thin cells do. And each of its columns is a
    // solution that has to be refined.
    auto programme = slender ? sparse_programme(problem, true) : dense_programme(problem);
    programme.instead = [&problem, slender] { return slender ? dense_programme(problem) : sparse_programme(problem, false); };
    return programme;
  };
  return {budget, problem.preconditioner(), make_explicit};
}

}  // namespace mortise::feti
