// The coarse problem: G = R'B', from dual to kernels, and e = R'f.
#pragma once

#include <memory>
#include <vector>

#include "constraint/constraints.hpp"
#include "fem/stiffness.hpp"
#include "feti/clusters.hpp"
#include "feti/jump_operator.hpp"
#include "qp/equality.hpp"

namespace mortise::feti {

/// G over the owned rows of this rank: kernels x rows. Collective.
SparseMatrix coarse_rows(const JumpOperator& jump, const Clusters& clusters, const Communicator& comm);

/// R_c'v_c of every cluster, on every rank: e for v = f. Collective.
Eigen::VectorXd kernel_coordinates(const Clusters& clusters, const std::vector<Eigen::VectorXd>& v, const Communicator& comm);

/// G with one more row for each pretension section that is tightened to a force, over the same columns: its parts of the (scaled)
/// contact rows.
SparseMatrix with_pretension_rows(const SparseMatrix& g, std::span<const constraint::PretensionSection> pretension_sections,
                                  const JumpOperator& jump);

}  // namespace mortise::feti
