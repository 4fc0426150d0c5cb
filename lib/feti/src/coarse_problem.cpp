#include "feti/coarse_problem.hpp"

namespace mortise::feti {

SparseMatrix coarse_rows(const partition::Decomposition& decomposition, const JumpOperator& jump, const Subdomains& subdomains,
                         const KernelNumbering& numbering, const Communicator& comm)
{
  std::vector<Eigen::MatrixXd> parts;
  std::vector<int> first;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& block = jump.blocks()[s];
    const Eigen::MatrixXd kernel = subdomains[s]->kernel().transpose();
    auto& part = parts.emplace_back(Eigen::MatrixXd::Zero(kernel.rows(), static_cast<Eigen::Index>(block.row.size())));
    for (std::size_t r = 0; r < block.row.size(); ++r)
      for (std::size_t i = block.offset[r]; i < block.offset[r + 1]; ++i)
        part.col(static_cast<Eigen::Index>(r)) += block.coefficient[i] * kernel.col(block.unknown[i]);
    first.push_back(numbering.first(decomposition.subdomains[s].id));
  }
  return jump.gather_columns(parts, first, numbering.first(decomposition.subdomain_count()), comm);
}

Eigen::VectorXd kernel_coordinates(const partition::Decomposition& decomposition, const Subdomains& subdomains,
                                   const std::vector<Eigen::VectorXd>& v, const KernelNumbering& numbering,
                                   const Communicator& comm)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(numbering.first(decomposition.subdomain_count()));
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    result.segment(numbering.first(decomposition.subdomains[s].id), numbering.dimension) =
        subdomains[s]->kernel().transpose() * v[s];
  comm.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

SparseMatrix with_cuts(const SparseMatrix& g, std::span<const constraint::Cut> cuts, const JumpOperator& jump)
{
  std::vector<Eigen::Triplet<double>> triplets;
  auto height = static_cast<int>(g.rows());
  for (const auto& cut : cuts) {
    if (!cut.preload.force) continue;
    for (const auto& [row, part] : cut.rows) {
      const auto column = jump.ranges().contacts + static_cast<Local>(row);
      triplets.emplace_back(height, column, part * jump.scale()[column]);
    }
    ++height;
  }
  SparseMatrix added(height, g.cols()), result = g;
  added.setFromTriplets(triplets.begin(), triplets.end());
  result.conservativeResize(height, g.cols());
  return result + added;
}

}  // namespace mortise::feti
