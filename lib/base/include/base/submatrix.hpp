// Blocks of sparse symmetric matrices.
#pragma once

#include <vector>

#include "base/cholesky.hpp"

namespace mortise {

/// Entries (rows[i], columns[j]) of the symmetric matrix with lower triangle `lower`; with `only_lower` those with i >= j. Both
/// lists are ascending.
SparseMatrix submatrix(const SparseMatrix& lower, const std::vector<int>& rows, const std::vector<int>& columns, bool only_lower);

}  // namespace mortise
