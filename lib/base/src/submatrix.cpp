#include "base/submatrix.hpp"

namespace mortise {

namespace {

std::vector<int> places(const std::vector<int>& list, Eigen::Index size)
{
  std::vector<int> result(static_cast<std::size_t>(size), -1);
  for (std::size_t i = 0; i < list.size(); ++i) result[static_cast<std::size_t>(list[i])] = static_cast<int>(i);
  return result;
}

}  // namespace

SparseMatrix submatrix(const SparseMatrix& lower, const std::vector<int>& rows, const std::vector<int>& columns, bool only_lower)
{
  const auto row_place = places(rows, lower.rows()), column_place = places(columns, lower.cols());
  std::vector<Eigen::Triplet<double>> triplets;
  const auto add = [&](Eigen::Index i, Eigen::Index j, double value) {
    const int row = row_place[static_cast<std::size_t>(i)], column = column_place[static_cast<std::size_t>(j)];
    if (row >= 0 && column >= 0 && (!only_lower || row >= column)) triplets.emplace_back(row, column, value);
  };
  for (int j = 0; j < lower.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(lower, j); it; ++it) {
      add(it.row(), j, it.value());
      if (it.row() != j) add(j, it.row(), it.value());
    }
  SparseMatrix result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

}  // namespace mortise
