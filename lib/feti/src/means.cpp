#include "feti/means.hpp"

#include <memory>
#include <utility>

#include "feti/explicit_problem.hpp"
#include "feti/sparse_problem.hpp"

namespace mortise::feti {

namespace {

qp::ExplicitProgramme sparse_programme(const DualSystem& system, bool slender)
{
  using Result = qp::ExplicitProgramme::Result;
  const auto matrices = std::make_shared<SparseProblem>(system, slender);
  const auto solve = [matrices](const qp::RightHandSide& right, const qp::FeasibleSet& set) {
    return matrices->solve(right, set);
  };
  const auto go_on = [matrices](const qp::RightHandSide& right, const Vector& d, const Eigen::VectorXd& e,
                                const qp::FeasibleSet& set,
                                const Result& near) { return matrices->go_on(right, d, e, set, near); };
  return {matrices, solve, go_on, true, {}, slender};
}

qp::ExplicitProgramme dense_programme(const DualSystem& system)
{
  using Result = qp::ExplicitProgramme::Result;
  const auto matrices = std::make_shared<ExplicitProblem>(system);
  const auto solve = [matrices](const qp::RightHandSide& right, const qp::FeasibleSet& set) {
    return matrices->solve(right.b, right.e, set);
  };
  const auto go_on = [matrices](const qp::RightHandSide&, const Vector& d, const Eigen::VectorXd& e, const qp::FeasibleSet& set,
                                const Result& near) { return matrices->solve(d, e, set, &near); };
  return {matrices, solve, go_on, matrices->differs()};
}

}  // namespace

qp::Means means_of(const DualSystem& system, qp::ActiveSetPreconditioner* preconditioner, qp::Budget& budget)
{
  const auto make_explicit = [&system] {
    const bool slender = system.slender();
    const auto turn = SparseProblem::turn(system, slender);
    if (turn == SparseProblem::Turn::alone) return sparse_programme(system, slender);
    if (turn == SparseProblem::Turn::first) {
      auto programme = sparse_programme(system, slender);
      programme.instead = [&system] { return dense_programme(system); };
      programme.instead_of_none = true;
      return programme;
    }
    if (turn == SparseProblem::Turn::never) return dense_programme(system);
    // F as a dense matrix is large in soft motions: little may be left in it of what thin cells do. And each of its columns is a
    // solution that has to be refined.
    auto programme = slender ? sparse_programme(system, true) : dense_programme(system);
    programme.instead = [&system, slender] { return slender ? dense_programme(system) : sparse_programme(system, false); };
    return programme;
  };
  return {budget, preconditioner, make_explicit};
}

}  // namespace mortise::feti
