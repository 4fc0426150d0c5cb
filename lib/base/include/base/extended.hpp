// Residuals of sparse matrices in extended precision.
#pragma once

#include "base/cholesky.hpp"

namespace mortise {

/// Bending of a thin body is up to 1e13 times as soft as its cells are: residuals of double precision have errors as large as
/// what bends it, and so have displacements of double precision times a stiffness.
using ExtendedVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// sums -= A x of a symmetric A, given by its lower triangle.
void subtract_product(const SparseMatrix& lower, const ExtendedVector& x, ExtendedVector& sums);
/// sums -= B'x.
void subtract_transposed_product(const Eigen::SparseMatrix<double, Eigen::RowMajor, int>& b, const Eigen::VectorXd& x,
                                 ExtendedVector& sums);

}  // namespace mortise
