#include "base/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

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

std::optional<MatrixXd> inverse(const MatrixXd& a, double least)
{
  const Eigen::FullPivLU<MatrixXd> factor(a);
  if (!(factor.rcond() >= least)) return std::nullopt;
  return factor.inverse();
}

double determinant(const MatrixXd& a)
{
  return a.determinant();
}

MatrixXd form(const MatrixXd& m, const MatrixXd& x)
{
  return x.transpose() * m * x;
}

VectorXd least_squares(const MatrixXd& a, const VectorXd& b)
{
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd minimum_norm(const MatrixXd& a, const MatrixXd& b)
{
  return a.completeOrthogonalDecomposition().solve(b);
}

RankedSolution minimum_norm(const MatrixXd& a, const MatrixXd& b, double threshold)
{
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factor(a.rows(), a.cols());
  factor.setThreshold(threshold);
  factor.compute(a);
  return {factor.solve(b), factor.rank()};
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

PlaneEigenpairs plane_eigenpairs(const Eigen::Matrix2d& a)
{
  // It is tridiagonal: what Eigen would do to make it so, to the same numbers, takes the compiler nine seconds.
  const double size = std::max({std::abs(a(0, 0)), std::abs(a(1, 0)), std::abs(a(1, 1))}), scale = size > 0 ? size : 1;
  const Eigen::Matrix2d scaled = a / scale;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeFromTridiagonal(scaled.diagonal(), scaled.diagonal<-1>());
  return {scale * solver.eigenvalues(), solver.eigenvectors()};
}

SpaceEigenpairs space_eigenpairs(const Eigen::Matrix3d& a)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::Vector3d space_eigenvalues(const Eigen::Matrix3d& a)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(a, Eigen::EigenvaluesOnly).eigenvalues();
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
