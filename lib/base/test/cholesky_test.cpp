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
