// Blocks of sparse symmetric matrices, and products with these.
#pragma once

#include <vector>

#include "base/cholesky.hpp"

namespace mortise {

/// Entries (rows[i], columns[j]) of the symmetric matrix with lower triangle `lower`; with `only_lower` those with i >= j. Both
/// lists are ascending.
SparseMatrix submatrix(const SparseMatrix& lower, const std::vector<int>& rows, const std::vector<int>& columns, bool only_lower);

/// Whether columns k block .. (k+1) block - 1 of a lower triangle have the same rows, as those of a node in a stiffness matrix
/// do: all of the diagonal block's, and below it the same list.
bool has_column_blocks(const SparseMatrix& lower, int block);

/// A u, A symmetric with the lower triangle `lower`. With column blocks of 2 or 3 the matrix is read at half of the price of
/// Eigen's product, which looks up the rows column by column; `block` 1 is that.
Eigen::VectorXd symmetric_product(const SparseMatrix& lower, int block, const Eigen::VectorXd& u);

}  // namespace mortise
