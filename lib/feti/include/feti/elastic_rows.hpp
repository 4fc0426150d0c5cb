// What springs add to the dual operator and to its approximate inverse. On their rows F becomes F + C, C = A^-1 with the
// stiffness A of all springs (constraint/springs.hpp), scaled as the rows of B are. Rows are scaled so that the diagonal of B
// D^-1 B' + C is 1, of which the springs have the part w. M + W C^-1 W, W = diag(w), is then near (F + C)^-1 for soft springs and
// for stiff ones: it is the energy of a jump of which the springs take the part w.
#pragma once

#include <optional>

#include "base/cholesky.hpp"
#include "constraint/springs.hpp"
#include "feti/jump_operator.hpp"

namespace mortise::feti {

/// Every rank has the matrices whole and solves with them by itself, as with those of the coarse problem. x and y are over the
/// rows of B. Refers to `comm`.
class ElasticRows {
 public:
  /// The own rows of `springs` are those of `jump` from ranges().springs on. Throws Error(bad_input) if A is not positive
  /// definite to rounding, Error(machine) when memory runs out. Collective.
  ElasticRows(const constraint::Springs& springs, const JumpOperator& jump, const Communicator& comm);

  /// y += alpha C x. Collective.
  void add_compliance(double alpha, const Vector& x, Vector& y) const;
  /// y += alpha W C^-1 W x. Collective.
  void add_stiffness(double alpha, const Vector& x, Vector& y) const;
  /// x'C x, twice the energy that the springs store under the multipliers x. Collective.
  double stored(const Vector& x) const;
  /// x'W C^-1 W x. Collective.
  double energy(const Vector& x) const;
  /// C, dense: rows of all springs squared. The same on every rank.
  Eigen::MatrixXd compliance() const;
  /// The entries of x at the rows of springs, x over the owned rows of B, whole on every rank. Collective.
  Eigen::VectorXd gather(const Eigen::Ref<const Eigen::VectorXd>& x) const;

 private:
  void add(double alpha, const Eigen::VectorXd& all, Vector& y) const;

  const Communicator& comm_;
  Local first_;
  std::vector<std::size_t> own_;
  SparseMatrix stiffness_;
  std::optional<Cholesky> factor_;
  Eigen::VectorXd scale_, weight_;  // of each spring row: that of B; w over the scale
};

}  // namespace mortise::feti
