// What springs add to the dual operator: F + C on their rows, C = A^-1 with the stiffness A of all springs
// (constraint/springs.hpp), scaled as the rows of B are; and to its approximate inverse. A row is scaled so that w + (1 - w) = 1
// is what A alone and D^-1 make of the diagonal; M + W A W, W the weights w, is then near (F + C)^-1 for soft springs and for
// stiff ones: it is the energy of a jump of which the springs take the part w.
#pragma once

#include <optional>

#include "base/cholesky.hpp"
#include "constraint/springs.hpp"
#include "feti/jump_operator.hpp"

namespace mortise::feti {

/// Every rank has the matrices whole and solves with them by itself, as with those of the coarse problem. Refers to `comm`.
class ElasticRows {
 public:
  /// `springs`, whose own rows are those from jump.ranges().springs on. Throws Error(machine) when memory runs out. Collective.
  ElasticRows(const constraint::Springs& springs, const JumpOperator& jump, const Communicator& comm);

  /// y += alpha C x. Collective.
  void add_compliance(double alpha, const Vector& x, Vector& y) const;
  /// y += alpha W C^-1 W x. Collective.
  void add_stiffness(double alpha, const Vector& x, Vector& y) const;
  /// x'C x, twice what the springs store under the forces x. Collective.
  double stored(const Vector& x) const;
  /// x'W C^-1 W x. Collective.
  double energy(const Vector& x) const;
  /// C, dense.
  Eigen::MatrixXd compliance() const;
  /// What each rank has for its own rows, whole on every one; x over the owned rows of B. Collective.
  Eigen::VectorXd gather(const Eigen::Ref<const Eigen::VectorXd>& x) const;

 private:
  void add(double alpha, const Eigen::VectorXd& all, Vector& y) const;

  const Communicator& comm_;
  Local first_;
  std::vector<std::size_t> own_;
  SparseMatrix stiffness_;
  std::optional<Cholesky> factor_;
  Eigen::VectorXd scale_, weight_;  // of each spring row: that of B; w over that
};

}  // namespace mortise::feti
