// What the solvers of lib/qp may use of a dual problem besides products with F.
#pragma once

#include "feti/dual_problem.hpp"
#include "qp/solver.hpp"

namespace mortise::feti {

/// The preconditioner of `problem`, and F and G as matrices (ExplicitProblem) for a solver that asks for them, which is then
/// collective. The products of such a solver have to be exact: see qp::SolverKind::exact_products and DualProblem::be_exact().
/// `problem` and `budget` outlive the result.
qp::Means means_of(const DualProblem& problem, qp::Budget& budget);

}  // namespace mortise::feti
