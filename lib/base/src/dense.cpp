#include "base/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace mortise::dense {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd solve_symmetric(const MatrixXd& a, const MatrixXd& b)
{
  return a.ldlt().solve(b);
}

MatrixXd solve_positive(const MatrixXd& a, const MatrixXd& b)
{
  return a.llt().solve(b);
}

VectorXd solve(const MatrixXd& a, const VectorXd& b)
{
  return a.partialPivLu().solve(b);
}

MatrixXd inverse(const MatrixXd& a)
{
  return a.inverse();
}

double determinant(const MatrixXd& a)
{
  return a.determinant();
}

VectorXd least_squares(const MatrixXd& a, const VectorXd& b)
{
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd minimum_norm(const MatrixXd& a, const MatrixXd& b)
{
  return a.completeOrthogonalDecomposition().solve(b);
}

MatrixXd orthogonal_factor(const MatrixXd& a)
{
  return a.householderQr().householderQ();
}

Eigen::VectorXi pivoted_columns(const MatrixXd& a)
{
  return a.colPivHouseholderQr().colsPermutation().indices();
}

Eigenpairs symmetric_eigenpairs(const MatrixXd& a)
{
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd symmetric_eigenvalues(const MatrixXd& a)
{
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigenpairs generalized_eigenpairs(const MatrixXd& a, const MatrixXd& b)
{
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigenpairs tridiagonal_eigenpairs(const VectorXd& diagonal, const VectorXd& beside)
{
  Eigen::SelfAdjointEigenSolver<MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace mortise::dense
