#include "feti/coarse_problem.hpp"

#include "row_scaling.hpp"

namespace mortise::feti {

namespace {

// What is left of a row's part of G when its subdomains take from each other, as gluing inside a cluster does, is rounding.
constexpr double rounding_of_row = 1e-10;

}  // namespace

SparseMatrix coarse_rows(const JumpOperator& jump, const Clusters& clusters, const Communicator& comm)
{
  std::vector<JumpOperator::Columns> parts;
  std::vector<int> place(jump.touched_rows()->getNodeNumElements(), -1);  // of a row among those of the cluster
  const auto& blocks = jump.blocks();
  for (std::size_t start = 0, end = 0; start < blocks.size(); start = end) {
    std::vector<Local> rows;
    for (end = start; end < blocks.size() && clusters.first(end) == clusters.first(start); ++end)
      for (const Local row : blocks[end].row)
        if (auto& at = place[static_cast<std::size_t>(row)]; at < 0) {
          at = static_cast<int>(rows.size());
          rows.push_back(row);
        }
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(clusters.modes(), count);
    Eigen::VectorXd size = Eigen::VectorXd::Zero(count);
    for (std::size_t s = start; s < end; ++s) {
      const Eigen::MatrixXd kernel = clusters.kernel(s).transpose();
      for (std::size_t r = 0; r < blocks[s].row.size(); ++r) {
        const int at = place[static_cast<std::size_t>(blocks[s].row[r])];
        Eigen::VectorXd part = Eigen::VectorXd::Zero(kernel.rows());
        for (std::size_t i = blocks[s].offset[r]; i < blocks[s].offset[r + 1]; ++i)
          part += blocks[s].coefficient[i] * kernel.col(blocks[s].unknown[i]);
        sum.col(at) += part;
        size[at] += part.norm();
      }
    }
    JumpOperator::Columns part{clusters.first(start), {}, Eigen::MatrixXd(sum.rows(), count)};
    for (Eigen::Index r = 0; r < count; ++r) {
      const Local row = rows[static_cast<std::size_t>(r)];
      place[static_cast<std::size_t>(row)] = -1;
      if (sum.col(r).norm() < rounding_of_row * size[r]) continue;
      part.values.col(static_cast<Eigen::Index>(part.row.size())) = sum.col(r);
      part.row.push_back(row);
    }
    parts.push_back(std::move(part));
  }
  return jump.gather_columns(parts, clusters.kernel_dimension(), comm);
}

Eigen::VectorXd kernel_coordinates(const Clusters& clusters, const std::vector<Eigen::VectorXd>& v, const Communicator& comm)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(clusters.kernel_dimension());
  for (std::size_t s = 0; s < v.size(); ++s) result.segment(clusters.first(s), clusters.modes()) += clusters.coordinates(s, v[s]);
  comm.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

Eigen::VectorXd load_coordinates(const Clusters& clusters, const std::vector<Eigen::VectorXd>& load, const Communicator& comm)
{
  constexpr double rounding = 1e-12;
  Eigen::VectorXd result = kernel_coordinates(clusters, load, comm);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(result.size());  // of the loads on each cluster
  for (std::size_t s = 0; s < load.size(); ++s)
    squares.segment(clusters.first(s), clusters.modes()).array() += load[s].squaredNorm();
  comm.sum_in_place({squares.data(), static_cast<std::size_t>(squares.size())});
  return (result.array().abs() <= rounding * squares.array().sqrt()).select(0, result);
}

std::vector<Unknown> unknowns(const constraint::Constraints& constraints, const JumpOperator& jump, int dimension)
{
  std::vector<Unknown> result;
  int group = 0;
  for (const auto& section : constraints.pretension_sections) {
    if (!section.preload.force) continue;
    Unknown unknown{group++, *section.preload.force, {}};
    for (const auto& [row, part] : section.rows)
      unknown.parts.push_back({jump.ranges().contacts + static_cast<Local>(row), part});
    result.push_back(std::move(unknown));
  }
  for (const auto& motion : constraint::unknown_motions(constraints, dimension)) {
    Unknown unknown{group + motion.coupling, motion.force, {}};
    for (const auto& [row, part] : motion.rows)
      unknown.parts.push_back({jump.ranges().dirichlet + static_cast<Local>(row), part});
    result.push_back(std::move(unknown));
  }
  return result;
}

SparseMatrix with_unknowns(const SparseMatrix& g, std::span<const Unknown> unknowns, const JumpOperator& jump)
{
  std::vector<Eigen::Triplet<double>> triplets;
  auto height = static_cast<int>(g.rows());
  for (const auto& unknown : unknowns) {
    for (const auto& [row, part] : unknown.parts) triplets.emplace_back(height, row, RowScaling::of(jump)[row] * part);
    ++height;
  }
  SparseMatrix added(height, g.cols()), result = g;
  added.setFromTriplets(triplets.begin(), triplets.end());
  result.conservativeResize(height, g.cols());
  return result + added;
}

}  // namespace mortise::feti
