// Dense linear algebra of matrices whose sizes are known at run time, compiled once: each of Eigen's decompositions takes seconds
// of the compiler's time in every file that names it. Fixed sizes but 2 x 2, and matrices that are factorized once for many
// solves, are for Eigen itself.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace mortise::dense {

/// A^-1 B of a symmetric A (n x n) that need not be definite, by L D L'; B is n x m.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// A^-1 B of a symmetric positive definite A (n x n), by L L'; B is n x m.
Eigen::MatrixXd solve_positive(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// A^-1 b of a regular A (n x n), by L U with partial pivoting.
Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
/// A^-1 and det A of A (n x n), by the same; whoever asks for the inverse sees to it that there is one.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);
/// The inverse by L U with complete pivoting; none where 1 / cond(A) in the 1-norm is below `least`.
std::optional<Eigen::MatrixXd> inverse(const Eigen::MatrixXd& a, double least);
double determinant(const Eigen::MatrixXd& a);

/// X' M X; M is n x n, X is n x k.
Eigen::MatrixXd form(const Eigen::MatrixXd& m, const Eigen::MatrixXd& x);

/// The x that make |A x - b| least, of full column rank (m x n, m >= n), by Q R with pivoted columns.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
/// The shortest of them, of an A of any shape and rank, by a complete orthogonal decomposition; B is m x k, the result n x k.
Eigen::MatrixXd minimum_norm(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
struct RankedSolution {
  Eigen::MatrixXd x;
  Eigen::Index rank;  ///< of A
};
/// The same, where pivots below `threshold` times the largest count as 0.
RankedSolution minimum_norm(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double threshold);
/// Q (m x m) of A = Q R, without pivoting: the first columns span those of A (m x n, m >= n), the rest is orthogonal to them.
Eigen::MatrixXd orthogonal_factor(const Eigen::MatrixXd& a);

/// The columns of A in the order in which a Q R with pivoting takes them; those that it can (as many as there are rows) come
/// first.
Eigen::VectorXi pivoted_columns(const Eigen::MatrixXd& a);

struct Eigenpairs {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< columns in the same order, orthonormal
};

/// Of a symmetric matrix, whose lower triangle is read.
Eigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& a);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);
struct PlaneEigenpairs {
  Eigen::Vector2d values;   ///< ascending
  Eigen::Matrix2d vectors;  ///< columns in the same order, orthonormal
};
/// Of a symmetric 2 x 2 matrix.
PlaneEigenpairs plane_eigenpairs(const Eigen::Matrix2d& a);
struct SpaceEigenpairs {
  Eigen::Vector3d values;   ///< ascending
  Eigen::Matrix3d vectors;  ///< columns in the same order, orthonormal
};
/// Of a symmetric 3 x 3 matrix.
SpaceEigenpairs space_eigenpairs(const Eigen::Matrix3d& a);
Eigen::Vector3d space_eigenvalues(const Eigen::Matrix3d& a);

/// A v = lambda B v of a symmetric A and a symmetric positive definite B, lower triangles; the vectors V with V'B V = 1.
Eigenpairs generalized_eigenpairs(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// Of the symmetric tridiagonal matrix with these n values on its diagonal and these n - 1 beside it.
Eigenpairs tridiagonal_eigenpairs(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);

}  // namespace mortise::dense
