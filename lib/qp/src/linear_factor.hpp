// Factors of the linear problems of sparse_system.hpp.
#pragma once

#include <memory>
#include <vector>

#include "base/extended.hpp"
#include "joined_stiffness.hpp"

namespace mortise::qp {

/// x = base + T a over blocks of unknowns of x, with equations along the columns of E', one matrix of each for a block:
///
///     K u + B'T a = f,   C a - E B u = r.
struct BlockEquations {
  std::vector<Eigen::MatrixXd> trial, test, compliance;  // T, E, C
};

class LinearFactor {
 public:
  virtual ~LinearFactor() = default;
  struct Step {
    Eigen::VectorXd u;
    std::vector<Eigen::VectorXd> a;  // of each block
  };
  /// (u, a) for f and r, to some figures.
  virtual Step solve(const Eigen::VectorXd& f, const std::vector<Eigen::VectorXd>& r) const = 0;
};

/// With a eliminated: K + B'T C^-1 E B, of `inverse` C^-1, T C^-1 E and what is near that for the factor. None if that is not
/// positive definite to rounding. `stiffness` and what it is of outlive it.
std::unique_ptr<LinearFactor> eliminated_factor(JoinedStiffness& stiffness, BlockEquations equations,
                                                std::vector<Eigen::MatrixXd> inverse, const std::vector<Eigen::MatrixXd>& near);

/// With nothing eliminated, by pivots: where bodies bend 1e12 times as softly as their cells give way, the sum above loses the
/// bending. Larger and slower. None if the equations are singular to rounding. Throws Error(machine) if memory runs out.
std::unique_ptr<LinearFactor> saddle_factor(const SparseMatrices& matrices, const std::vector<JoinedStiffness::Block>& blocks,
                                            const BlockEquations& equations);

/// -K u - B'x - e.
Eigen::VectorXd lacking_forces(const SparseMatrices& matrices, const Eigen::VectorXd& x, const ExtendedVector& u,
                               const Eigen::VectorXd& e);

}  // namespace mortise::qp
