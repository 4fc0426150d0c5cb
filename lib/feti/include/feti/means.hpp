// What the solvers of lib/qp may use of a dual system besides products with F.
#pragma once

#include "feti/dual_system.hpp"
#include "qp/solver.hpp"

namespace mortise::feti {

/// A preconditioner of `system`, or null, and F and G as matrices (ExplicitProblem) for a solver that asks for them, which is
/// then collective. The products of such a solver have to be exact: see qp::SolverKind::exact_products and Products. All
/// arguments outlive the result.
qp::Means means_of(const DualSystem& system, qp::ActiveSetPreconditioner* preconditioner, qp::Budget& budget);

}  // namespace mortise::feti
