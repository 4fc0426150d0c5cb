// What a dual problem offers to the solvers of lib/qp beside itself.
#pragma once

#include "feti/dual_problem.hpp"
#include "qp/solver.hpp"

namespace mortise::feti {

/// Its preconditioner, and F and G as matrices for a solver that asks for them. `problem` and `budget` outlive it.
qp::Means means_of(const DualProblem& problem, qp::Budget& budget);

}  // namespace mortise::feti
