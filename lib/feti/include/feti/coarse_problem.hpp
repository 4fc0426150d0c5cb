// The coarse problem: G = R'B', from dual to kernels, and e = R'f.
#pragma once

#include <memory>
#include <vector>

#include "feti/jump_operator.hpp"
#include "feti/subdomain_operator.hpp"
#include "partition/decomposition.hpp"
#include "qp/equality.hpp"

namespace mortise::feti {

/// Where the kernel of each subdomain stands among all: subdomain s (global number) has the coordinates first(s) ..
/// first(s)+dim-1.
struct KernelNumbering {
  int dimension = 6;  ///< of each kernel: 6, or 3 in two dimensions
  int first(Global subdomain) const { return static_cast<int>(subdomain) * dimension; }
};

/// G over the owned rows of this rank: kernels x rows. Collective.
SparseMatrix coarse_rows(const partition::Decomposition& decomposition, const JumpOperator& jump, const Subdomains& subdomains,
                         const Communicator& comm);

/// R_s'v_s of every subdomain, on every rank: e for v = f. Collective.
Eigen::VectorXd kernel_coordinates(const partition::Decomposition& decomposition, const Subdomains& subdomains,
                                   const std::vector<Eigen::VectorXd>& v, const Communicator& comm);

}  // namespace mortise::feti
