#include "feti/coarse_problem.hpp"

namespace mortise::feti {

SparseMatrix coarse_rows(const partition::Decomposition& decomposition, const JumpOperator& jump, const Subdomains& subdomains,
                         const Communicator& comm)
{
  const KernelNumbering numbering{decomposition.catalogue.dimension == 3 ? 6 : 3};
  std::vector<JumpOperator::Contribution> contributions;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& block = jump.blocks()[s];
    const auto& kernel = subdomains[s]->kernel();
    const int first = numbering.first(decomposition.subdomains[s].id);
    for (std::size_t r = 0; r < block.row.size(); ++r) {
      Eigen::RowVectorXd product = Eigen::RowVectorXd::Zero(kernel.cols());
      for (std::size_t i = block.offset[r]; i < block.offset[r + 1]; ++i)
        product += block.coefficient[i] * kernel.row(block.unknown[i]);
      for (int k = 0; k < product.size(); ++k) contributions.push_back({block.row[r], first + k, product[k]});
    }
  }
  return jump.gather_columns(contributions, numbering.first(decomposition.subdomain_count()), comm);
}

Eigen::VectorXd kernel_coordinates(const partition::Decomposition& decomposition, const Subdomains& subdomains,
                                   const std::vector<Eigen::VectorXd>& v, const Communicator& comm)
{
  const KernelNumbering numbering{decomposition.catalogue.dimension == 3 ? 6 : 3};
  Eigen::VectorXd result = Eigen::VectorXd::Zero(numbering.first(decomposition.subdomain_count()));
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    result.segment(numbering.first(decomposition.subdomains[s].id), numbering.dimension) =
        subdomains[s]->kernel().transpose() * v[s];
  comm.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

}  // namespace mortise::feti
