// The dual problem as matrices, for a direct solution.
#pragma once

#include "feti/dual_problem.hpp"
#include "qp/condensed_newton.hpp"

namespace mortise::feti {

class DirichletElimination;

/// Rows of supports along axes that are not worth an elimination. It costs figures where F is large beside what balanced forces
/// do, as that of a thin plate is: products with F, to which a solution is shown, have the rounding of another factor.
constexpr Global few_supports = 2000;

/// F and G on rank 0 over the rows that are left when supports along axes are eliminated; of use where these are some thousand.
/// As an operator it is F^-1, the best of all preconditioners. Heavy: neither copies nor moves.
class ExplicitProblem : public qp::ActiveSetPreconditioner {
 public:
  /// If there are more than `few` supports along axes, factorizes each subdomain that has any with them, and solves for the
  /// columns of its inverse times B', as many as its other rows of B. Not for clusters of several subdomains. The problem
  /// outlives it. Throws as qp::CondensedNewton, Error(bad_input) if a supported subdomain is not positive definite, and
  /// Error(machine) if memory runs out. Collective.
  explicit ExplicitProblem(const DualProblem& problem, Global few = few_supports);
  ~ExplicitProblem() override;

  struct Result {
    Vector x;
    Eigen::VectorXd nu;
    bool converged = false;
    int steps = 0;
  };
  /// The solution with the loads, bounds and given slip bounds that the problem has by now, exact to rounding if `converged`.
  /// Collective.
  Result solve() const;

  Teuchos::RCP<const Map> getDomainMap() const override { return problem_.jump().rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return problem_.jump().rows(); }
  /// y = alpha F^-1 x + beta y. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;
  void fix(std::span<const Local>) override {}  // of all x there are the bound holds the more

 private:
  qp::FeasibleSet whole_set() const;
  std::vector<double> to_root(const Vector& x) const;
  Vector from_root(std::vector<double> all) const;

  const DualProblem& problem_;
  std::unique_ptr<const DirichletElimination> elimination_;
  std::unique_ptr<qp::CondensedNewton> newton_;  // rank 0
};

}  // namespace mortise::feti
