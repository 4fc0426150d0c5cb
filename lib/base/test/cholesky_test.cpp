#include "base/cholesky.hpp"

#include <gtest/gtest.h>

namespace mortise {
namespace {

// The lower triangle of the five-point Laplacian on an n x n grid, plus `shift` on the diagonal.
SparseMatrix laplacian(int n, double shift)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = n * j + i;
      entries.emplace_back(k, k, 4 + shift);
      if (i + 1 < n) entries.emplace_back(k + 1, k, -1);
      if (j + 1 < n) entries.emplace_back(k + n, k, -1);
    }
  SparseMatrix a(n * n, n * n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

TEST(Cholesky, SolvesSeveralRightHandSides)
{
  const auto a = laplacian(20, 0);
  Cholesky factor(a);
  ASSERT_TRUE(factor.factorize(a));
  const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(400, 3);
  const Eigen::MatrixXd b = a.selfadjointView<Eigen::Lower>() * expected;
  Eigen::MatrixXd x(400, 3);
  factor.solve(b.data(), x.data(), 3, 400);
  EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
  EXPECT_GT(factor.factor_bytes(), 400 * sizeof(double));
}

// All widths of blocks, supernodes wider than one piece, and a new factorization afterwards.
TEST(Cholesky, PreparedFactorSolvesTheSame)
{
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(70, 70);
  const SparseMatrix dense = Eigen::MatrixXd(root * root.transpose() + 10 * Eigen::MatrixXd::Identity(70, 70)).sparseView();
  for (const auto& a : {laplacian(20, 0), laplacian(1, 0), SparseMatrix(dense.triangularView<Eigen::Lower>())}) {
    const auto n = static_cast<int>(a.rows());
    Cholesky factor(a, n % 2 == 0 ? 2 : 1);
    for (const double scale : {1.0, 3.0}) {
      ASSERT_TRUE(factor.factorize(SparseMatrix(scale * a)));
      const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(n, 31);  // one of each kernel: 16 + 8 + 4 + 2 + 1
      const Eigen::MatrixXd b = a.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd(scale * expected);
      factor.prepare_for_many_solves();
      Eigen::MatrixXd x = Eigen::MatrixXd::Constant(n + 2, 31, 7);
      x.topRows(n) = b;
      factor.solve(x.data(), x.data(), 31, n + 2);
      EXPECT_LT((x.topRows(n) - expected).norm(), 1e-11 * expected.norm());
      EXPECT_EQ(x(n, 30), 7);
    }
  }
}

TEST(Cholesky, TellsAnIndefiniteMatrixAndRecovers)
{
  Cholesky factor(laplacian(10, 0));
  EXPECT_FALSE(factor.factorize(laplacian(10, -4)));
  const auto a = laplacian(10, 1);
  ASSERT_TRUE(factor.factorize(a));
  const Eigen::VectorXd expected = Eigen::VectorXd::Random(100);
  const Eigen::VectorXd b = a.selfadjointView<Eigen::Lower>() * expected;
  EXPECT_LT((factor.solve(b) - expected).norm(), 1e-11 * expected.norm());
}

}  // namespace
}  // namespace mortise
