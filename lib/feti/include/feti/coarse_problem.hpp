// The coarse problem: G = R'B', from dual to kernels, and e = R'f.
#pragma once

#include <memory>
#include <vector>

#include "constraint/coupling.hpp"
#include "fem/stiffness.hpp"
#include "feti/clusters.hpp"
#include "feti/jump_operator.hpp"
#include "qp/equality.hpp"

namespace mortise::feti {

/// G over the owned rows of this rank: kernels x rows. Collective.
SparseMatrix coarse_rows(const JumpOperator& jump, const Clusters& clusters, const Communicator& comm);

/// R_c'v_c of every cluster, whole on every rank: e for v = f. v[s]: over the unknowns of the s-th subdomain. Collective.
Eigen::VectorXd kernel_coordinates(const Clusters& clusters, const std::vector<Eigen::VectorXd>& v, const Communicator& comm);

/// The same of loads, e = R'f, with zeros where the forces on a cluster cancel but for rounding, as those of thermal expansion
/// do: what is left would be taken for a load that lifts a body off what it lies on. Collective.
Eigen::VectorXd load_coordinates(const Clusters& clusters, const std::vector<Eigen::VectorXd>& load, const Communicator& comm);

/// An unknown s besides displacements and kernels, a length: the shortening of a pretension section that is tightened to a force,
/// or a component of the motion of a rigid coupling's point (an angle times Coupling::arm). Rows give way to it,
/// row . u = bound + part s.
struct Unknown {
  int group;     ///< unknowns of one group may share rows
  double force;  ///< does the work force * s
  struct Part {
    Local row;  ///< owned, of B
    double part;
  };
  std::vector<Part> parts;  ///< of the rows as they were given
};

/// All of them: pretension sections, then couplings. The same on every rank but for `parts`, which are those of its own rows.
std::vector<Unknown> unknowns(const constraint::Constraints& constraints, const JumpOperator& jump, int dimension);

/// G with one more row for each unknown, over the same columns: its parts of the (scaled) rows.
SparseMatrix with_unknowns(const SparseMatrix& g, std::span<const Unknown> unknowns, const JumpOperator& jump);

}  // namespace mortise::feti
