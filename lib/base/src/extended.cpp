#include "base/extended.hpp"

namespace mortise {

void subtract_product(const SparseMatrix& lower, const ExtendedVector& x, ExtendedVector& sums)
{
  for (int j = 0; j < lower.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(lower, j); entry; ++entry) {
      const auto value = static_cast<long double>(entry.value());
      sums[entry.row()] -= value * x[j];
      if (entry.row() != j) sums[j] -= value * x[entry.row()];
    }
}

void subtract_transposed_product(const Eigen::SparseMatrix<double, Eigen::RowMajor, int>& b, const Eigen::VectorXd& x,
                                 ExtendedVector& sums)
{
  for (int row = 0; row < b.rows(); ++row)
    for (Eigen::SparseMatrix<double, Eigen::RowMajor, int>::InnerIterator entry(b, row); entry; ++entry)
      sums[entry.col()] -= static_cast<long double>(entry.value()) * x[row];
}

}  // namespace mortise
