// Random programmes with their matrices, for solvers that start from an exact solution.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "qp/condensed_newton.hpp"
#include "qp/solver.hpp"
#include "random_programme.hpp"

namespace mortise::qp {

// The matrices of a random programme, whole on every rank.
class DenseProgramme : public ActiveSetPreconditioner {
 public:
  // `compliance` on the diagonal is none of A.
  explicit DenseProgramme(RandomProgramme& programme, double compliance = 0) : programme_(programme), compliance_(compliance) {}
  Teuchos::RCP<const Map> getDomainMap() const override { return programme_.map; }
  Teuchos::RCP<const Map> getRangeMap() const override { return programme_.map; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const override
  {
    const Eigen::VectorXd whole = programme_.dense.llt().solve(gathered(*x.getVector(0), world()));
    y.getVectorNonConst(0)->update(alpha, local_part(whole, programme_.map), beta);
  }
  void fix(std::span<const Local>, std::span<const SlipDirection>) override {}

  ExplicitProgramme::Result solve(const RightHandSide& right) const { return solve(right.b, right.e, nullptr); }
  ExplicitProgramme::Result solve(const Vector& b, const Eigen::VectorXd& e, const ExplicitProgramme::Result* near) const
  {
    FeasibleSet set = RandomProgramme::bounds_and_discs(RandomProgramme::n);  // of all ranks: all discs are alike
    const auto discs = programme_.set.discs();
    set.set_coefficients(std::vector<double>(set.discs().size(), discs.front().coefficient));
    constexpr auto n = RandomProgramme::n;
    const CondensedNewton newton(programme_.dense + compliance_ * Eigen::MatrixXd::Identity(n, n), programme_.g,
                                 Eigen::MatrixXd::Zero(programme_.g.rows(), programme_.g.rows()), set);
    CondensedNewton::Result from;
    if (near) from = {gathered(near->x, world()), near->nu, true, 0, gathered(*near->reaction, world())};
    const auto found = newton.solve(gathered(b, world()), e, set, near ? &from : nullptr);
    return {local_part(found.x, programme_.map), found.nu, found.converged, local_part(found.reaction, programme_.map)};
  }

 private:
  RandomProgramme& programme_;
  double compliance_;
};

// A random programme, with what solvers of it are made of.
struct Setting {
  RandomProgramme programme;
  Budget budget{programme.hessian, {}, false};
  Means means{budget, nullptr, [this] { return explicit_programme(); }};

  // With its matrices, or with what `changed` makes of their solution.
  ExplicitProgramme explicit_programme(std::function<void(ExplicitProgramme::Result&)> changed = {}, double compliance = 0)
  {
    const auto matrices = std::make_shared<DenseProgramme>(programme, compliance);
    return {matrices, [matrices, changed](const RightHandSide& right, const FeasibleSet&) {
              auto found = matrices->solve(right);
              if (changed) changed(found);
              return found;
            }};
  }
  std::unique_ptr<Solver> make(const SolverKind& kind) { return kind.make(programme.programme, means); }
  // With the radii that the programme has. Collective.
  void begin(Solver& solver, std::optional<Solution>& start, Goal& goal, const Observer& observer = {}) const
  {
    solver.begin(programme.right, programme.set.radii(), start, goal, observer);
  }
  Solution solve(Solver& solver, const std::optional<Solution>& start, const Goal& goal, const Observer& observer = {}) const
  {
    return solver.solve(programme.right, programme.set.radii(), start, goal, observer);
  }
};

}  // namespace mortise::qp
