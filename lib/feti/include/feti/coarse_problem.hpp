// The coarse problem: G = R'B', from dual to kernels, and e = R'f.
#pragma once

#include <memory>
#include <vector>

#include "constraint/constraints.hpp"
#include "fem/stiffness.hpp"
#include "feti/jump_operator.hpp"
#include "feti/subdomain_operator.hpp"
#include "partition/decomposition.hpp"
#include "qp/equality.hpp"

namespace mortise::feti {

/// Where the kernel of each subdomain stands among all: subdomain s (global number) has the coordinates first(s) ..
/// first(s)+dim-1.
struct KernelNumbering {
  explicit KernelNumbering(fem::Kinematics kinematics) : dimension(fem::rigid_motion_count(kinematics)) {}

  int dimension;  ///< of each kernel
  int first(Global subdomain) const { return static_cast<int>(subdomain) * dimension; }
};

/// G over the owned rows of this rank: kernels x rows. Collective.
SparseMatrix coarse_rows(const partition::Decomposition& decomposition, const JumpOperator& jump, const Subdomains& subdomains,
                         const KernelNumbering& numbering, const Communicator& comm);

/// R_s'v_s of every subdomain, on every rank: e for v = f. Collective.
Eigen::VectorXd kernel_coordinates(const partition::Decomposition& decomposition, const Subdomains& subdomains,
                                   const std::vector<Eigen::VectorXd>& v, const KernelNumbering& numbering,
                                   const Communicator& comm);

/// G with one more row for each cut that is tightened to a force, over the same columns: its parts of the (scaled) contact rows.
SparseMatrix with_cuts(const SparseMatrix& g, std::span<const constraint::Cut> cuts, const JumpOperator& jump);

}  // namespace mortise::feti
