#include "base/submatrix.hpp"

#include <algorithm>
#include <numeric>

namespace mortise {

namespace {

std::vector<int> places(const std::vector<int>& list, Eigen::Index size)
{
  std::vector<int> result(static_cast<std::size_t>(size), -1);
  for (std::size_t i = 0; i < list.size(); ++i) result[static_cast<std::size_t>(list[i])] = static_cast<int>(i);
  return result;
}

// The columns of a block share one list of rows, so that what they add to a row goes there once.
template <int Block>
Eigen::VectorXd product_by_blocks(const SparseMatrix& lower, const Eigen::VectorXd& u)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
  const double* const x = u.data();
  double* const y = result.data();
  for (int first = 0; first < lower.cols(); first += Block) {
    const int* start = lower.outerIndexPtr() + first;
    const double* value[Block];
    double own[Block], sum[Block] = {};
    for (int k = 0; k < Block; ++k) {
      value[k] = lower.valuePtr() + start[k];
      own[k] = x[first + k];
    }
    for (int k = 0; k < Block; ++k) {
      sum[k] += *value[k]++ * own[k];
      for (int r = k + 1; r < Block; ++r, ++value[k]) {
        sum[k] += *value[k] * own[r];
        sum[r] += *value[k] * own[k];
      }
    }
    const int* const rows = lower.innerIndexPtr() + start[0] + Block;
    const int count = start[1] - start[0] - Block;
    for (int i = 0; i < count; ++i) {
      double added = y[rows[i]];
      for (int k = 0; k < Block; ++k) {
        added += value[k][i] * own[k];
        sum[k] += value[k][i] * x[rows[i]];
      }
      y[rows[i]] = added;
    }
    for (int k = 0; k < Block; ++k) y[first + k] += sum[k];
  }
  return result;
}

}  // namespace

// Entries come column by column and in each by ascending rows: first those above the diagonal, by columns of `lower`, then its own.
SparseMatrix submatrix(const SparseMatrix& lower, const std::vector<int>& rows, const std::vector<int>& columns, bool only_lower)
{
  const auto row_place = places(rows, lower.rows()), column_place = places(columns, lower.cols());
  const auto for_each = [&](const auto& take) {
    const auto add = [&](Eigen::Index i, Eigen::Index j, double value) {
      const int row = row_place[static_cast<std::size_t>(i)], column = column_place[static_cast<std::size_t>(j)];
      if (row >= 0 && column >= 0 && (!only_lower || row >= column)) take(row, column, value);
    };
    for (int j = 0; j < lower.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(lower, j); it; ++it) {
        add(it.row(), j, it.value());
        if (it.row() != j) add(j, it.row(), it.value());
      }
  };
  SparseMatrix result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  int* const start = result.outerIndexPtr();
  for_each([&](int, int column, double) { ++start[column + 1]; });
  std::partial_sum(start, start + columns.size() + 1, start);
  result.resizeNonZeros(start[columns.size()]);
  std::vector<int> next(start, start + columns.size());
  for_each([&](int row, int column, double value) {
    const int at = next[static_cast<std::size_t>(column)]++;
    result.innerIndexPtr()[at] = row;
    result.valuePtr()[at] = value;
  });
  return result;
}

bool has_column_blocks(const SparseMatrix& lower, int block)
{
  if (!lower.isCompressed() || lower.cols() % block != 0) return false;
  for (int first = 0; first < lower.cols(); first += block) {
    const int* const start = lower.outerIndexPtr() + first;
    const int* const rows = lower.innerIndexPtr() + start[0];
    const int* const end = lower.innerIndexPtr() + start[1];
    if (end - rows < block) return false;
    for (int r = 0; r < block; ++r)
      if (rows[r] != first + r) return false;
    for (int k = 1; k < block; ++k)
      if (!std::equal(rows + k, end, lower.innerIndexPtr() + start[k], lower.innerIndexPtr() + start[k + 1])) return false;
  }
  return true;
}

Eigen::VectorXd symmetric_product(const SparseMatrix& lower, int block, const Eigen::VectorXd& u)
{
  if (block == 2) return product_by_blocks<2>(lower, u);
  if (block == 3) return product_by_blocks<3>(lower, u);
  return lower.selfadjointView<Eigen::Lower>() * u;
}

}  // namespace mortise
