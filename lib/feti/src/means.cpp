#include "feti/means.hpp"

#include <memory>
#include <utility>

#include "feti/explicit_problem.hpp"
#include "feti/sparse_problem.hpp"

namespace mortise::feti {

namespace {

qp::ExplicitProgramme sparse_programme(const DualProblem& problem)
{
  using Point = qp::ExplicitProgramme::Point;
  const auto matrices = std::make_shared<SparseProblem>(problem);
  const auto point = [](SparseProblem::Result found) {
    return Point{std::move(found.x), std::move(found.nu), found.converged, std::move(found.reaction), found.settled};
  };
  const auto go_on = [matrices, point](const Vector& linear, const Eigen::VectorXd& e, const Point& near) {
    return point(matrices->go_on(linear, e, near.x));
  };
  return {matrices, [matrices, point] { return point(matrices->solve()); }, go_on};
}

}  // namespace

qp::Means means_of(const DualProblem& problem, qp::Budget& budget)
{
  const auto make_explicit = [&problem] {
    const auto turn = SparseProblem::turn(problem);
    if (turn == SparseProblem::Turn::first) return sparse_programme(problem);
    const auto matrices = std::make_shared<ExplicitProblem>(problem);
    using Point = qp::ExplicitProgramme::Point;
    const auto point = [](ExplicitProblem::Result found) {
      return Point{std::move(found.x), std::move(found.nu), found.converged, std::move(found.reaction), found.settled};
    };
    const auto solve = [matrices, point] { return point(matrices->solve()); };
    const auto go_on = [matrices, point](const Vector& linear, const Eigen::VectorXd& e, const Point& near) {
      const ExplicitProblem::Result from{Vector(near.x, Teuchos::Copy), near.nu, near.converged, 0,
                                         Vector(*near.reaction, Teuchos::Copy)};
      return point(matrices->solve(linear, e, &from));
    };
    qp::ExplicitProgramme programme{matrices, solve};
    if (matrices->differs()) programme.go_on = go_on;
    if (turn == SparseProblem::Turn::second) programme.instead = [&problem] { return sparse_programme(problem); };
    return programme;
  };
  return {budget, problem.preconditioner(), make_explicit};
}

}  // namespace mortise::feti
