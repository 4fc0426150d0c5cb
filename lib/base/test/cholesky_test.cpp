#include "base/cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/extended.hpp"
#include "base/sparse_lu.hpp"
#include "base/submatrix.hpp"

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

// Every number of right-hand sides up to more than the widest kernel takes, supernodes wider than one piece, and a new
// factorization afterwards.
TEST(Cholesky, PreparedFactorSolvesTheSame)
{
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(70, 70);
  const SparseMatrix dense = Eigen::MatrixXd(root * root.transpose() + 10 * Eigen::MatrixXd::Identity(70, 70)).sparseView();
  for (const auto& a : {laplacian(20, 0), laplacian(1, 0), SparseMatrix(dense.triangularView<Eigen::Lower>())}) {
    const auto n = static_cast<int>(a.rows());
    Cholesky factor(a, n % 2 == 0 ? 2 : 1);
    for (const double scale : {1.0, 3.0}) {
      ASSERT_TRUE(factor.factorize(SparseMatrix(scale * a)));
      factor.prepare_for_many_solves();
      for (int count = 1; count < 20; ++count) {
        const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(n, count);
        Eigen::MatrixXd x = Eigen::MatrixXd::Constant(n + 2, count, 7);
        x.topRows(n) = a.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd(scale * expected);
        factor.solve(x.data(), x.data(), count, n + 2);
        EXPECT_LT((x.topRows(n) - expected).norm(), 1e-11 * expected.norm()) << count << " right-hand sides";
        EXPECT_EQ(x(n, count - 1), 7);
      }
    }
  }
}

// Rounded to single precision, against the dense solution: near it, the same for every number of right-hand sides, and symmetric,
// x'A~^-1 y = y'A~^-1 x, as far as double precision goes.
TEST(Cholesky, FactorInSinglePrecisionIsSymmetric)
{
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(70, 70);
  const SparseMatrix dense = Eigen::MatrixXd(root * root.transpose() + 10 * Eigen::MatrixXd::Identity(70, 70)).sparseView();
  for (const auto& a : {laplacian(20, 0), laplacian(9, 0.1), SparseMatrix(dense.triangularView<Eigen::Lower>())}) {
    const auto n = static_cast<int>(a.rows());
    const Eigen::MatrixXd whole = Eigen::MatrixXd(a).selfadjointView<Eigen::Lower>();
    Cholesky factor(a, n % 2 == 0 ? 2 : 1);
    ASSERT_TRUE(factor.factorize(a));
    const double rounding = factor.prepare_in_single_precision(a, n % 2 == 0 ? 2 : 1, 1e-5);
    ASSERT_TRUE(factor.in_single_precision());
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(n, n);
    for (int c = 0; c < n; ++c) factor.solve(inverse.col(c).data(), inverse.col(c).data(), 1, n);
    EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-13 * inverse.norm());
    const Eigen::MatrixXd half = whole.llt().matrixL();
    const Eigen::MatrixXd change = half.transpose() * inverse * half - Eigen::MatrixXd::Identity(n, n);
    const double radius = change.selfadjointView<Eigen::Lower>().eigenvalues().cwiseAbs().maxCoeff();
    EXPECT_GT(radius, 1e-9);
    EXPECT_LT(rounding, 1.01 * radius);
    EXPECT_GT(rounding, 0.4 * radius);
    for (int count = 1; count < 20; ++count) {
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(n, count);
      Eigen::MatrixXd x(n, count);
      factor.solve(b.data(), x.data(), count, n);
      EXPECT_LT((x - inverse * b).norm(), 1e-12 * x.norm()) << count << " right-hand sides";
      EXPECT_LT((x - whole.llt().solve(b)).norm(), 1e-4 * x.norm()) << count << " right-hand sides";
    }
  }
}

// A spectrum over 7 decades, and numbers that single precision does not know.
TEST(Cholesky, FactorThatRoundingWouldSpoilStaysInDoublePrecision)
{
  const auto a = laplacian(20, 0);
  const double least = 8 * std::pow(std::sin(std::acos(-1.0) / 42), 2);  // eigenvalue
  const auto soft = laplacian(20, -(1 - 1e-5) * least);
  for (const auto& matrix : {soft, SparseMatrix(1e90 * a), SparseMatrix(1e-90 * a)}) {
    Cholesky factor(matrix);
    ASSERT_TRUE(factor.factorize(matrix));
    const double rounding = factor.prepare_in_single_precision(matrix, 1, 1e-6);
    EXPECT_FALSE(rounding <= 1e-6);
    EXPECT_FALSE(factor.in_single_precision());
    const Eigen::VectorXd expected = Eigen::VectorXd::Random(400);
    const Eigen::VectorXd b = matrix.selfadjointView<Eigen::Lower>() * expected;
    EXPECT_LT((factor.solve(b) - expected).norm(), 1e-7 * expected.norm());
  }
}

// Other numbers, and entries above the diagonal that do not count.
TEST(Cholesky, FactorizesOnceMore)
{
  const auto a = laplacian(20, 0);
  const SparseMatrix whole = 2 * a + SparseMatrix(3 * SparseMatrix(a.transpose()));
  Cholesky factor(a);
  for (const auto& matrix : {a, SparseMatrix(4 * a), whole, a}) {
    ASSERT_TRUE(factor.factorize(matrix));
    const Eigen::VectorXd expected = Eigen::VectorXd::Random(400);
    const Eigen::VectorXd b = matrix.selfadjointView<Eigen::Lower>() * expected;
    EXPECT_LT((factor.solve(b) - expected).norm(), 1e-11 * expected.norm());
  }
}

// Supernodes of all shapes; rows below them that follow each other but for one, at the end of the matrix too.
TEST(Cholesky, PreparedFactorSolvesIrregularPatterns)
{
  for (int n = 20; n < 60; ++n) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n);
    a = (a.array().abs() < 2.5 / n).select(a, 0);
    a = (a * a.transpose()).eval();
    a.diagonal().array() += 1;
    const SparseMatrix lower = Eigen::MatrixXd(a.triangularView<Eigen::Lower>()).sparseView();
    Cholesky factor(lower);
    ASSERT_TRUE(factor.factorize(lower));
    factor.prepare_for_many_solves();
    for (int count : {1, 2, 3, 7}) {
      const Eigen::MatrixXd expected = Eigen::MatrixXd::Random(n, count);
      Eigen::MatrixXd x = a * expected;
      factor.solve(x.data(), x.data(), count, n);
      EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm()) << n << " unknowns, " << count << " right-hand sides";
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

// Against the dense matrix: nodes of 2 and 3 unknowns, some of them alone, and matrices whose columns differ.
TEST(SymmetricProduct, IsThatOfTheDenseMatrix)
{
  for (const int block : {1, 2, 3, 4})
    for (const int nodes : {1, 2, 17}) {
      const Eigen::MatrixXd linked =
          (Eigen::MatrixXd::Random(nodes, nodes).array() < -0.3).cast<double>() + Eigen::MatrixXd::Identity(nodes, nodes).array();
      const int n = nodes * block;
      Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n).array() + 2;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          if (linked(i / block, j / block) == 0) a(i, j) = 0;
      SparseMatrix lower = Eigen::MatrixXd(a.triangularView<Eigen::Lower>()).sparseView();
      const Eigen::MatrixXd dense = a.selfadjointView<Eigen::Lower>();
      const Eigen::VectorXd u = Eigen::VectorXd::Random(n);
      ASSERT_TRUE(has_column_blocks(lower, block));
      EXPECT_LT((symmetric_product(lower, block, u) - dense * u).norm(), 1e-14 * n * dense.norm());
      if (block > 1) {
        lower.coeffRef(n - 1, 0) = 0;
        lower.prune(1e-3);
        EXPECT_EQ(has_column_blocks(lower, block), a(n - 1, 0) == 0);
      }
    }
}

// Of constraints without a diagonal, too.
TEST(SparseLu, SolvesWhatIsIndefinite)
{
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(9, 9);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(3, 6), c = Eigen::MatrixXd::Random(3, 6);
  a.topLeftCorner(6, 6) = Eigen::MatrixXd::Random(6, 6) + 4 * Eigen::MatrixXd::Identity(6, 6);
  a.topRightCorner(6, 3) = b.transpose();
  a.bottomLeftCorner(3, 6) = -c;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(9, -1, 3);
  const auto factor = SparseLu::factorized(a.sparseView());
  ASSERT_TRUE(factor);
  EXPECT_LT((factor->solve(a * x) - x).norm(), 1e-11 * x.norm());
}

TEST(SparseLu, RefusesWhatIsSingular)
{
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(4, 4);
  a(3, 3) = 0;
  EXPECT_FALSE(SparseLu::factorized(a.sparseView()));
}

// Figures that double precision has no room for.
TEST(ExtendedProducts, KeepWhatDoublePrecisionLoses)
{
  SparseMatrix lower(2, 2);
  lower.insert(0, 0) = 0x1p35;
  lower.insert(1, 0) = -0x1p35;
  lower.insert(1, 1) = 0x1p35;
  const long double little = 0x1p-58L;
  ExtendedVector x(2), sums = ExtendedVector::Zero(2);
  x << 1 + little, 1;
  subtract_product(lower, x, sums);
  EXPECT_EQ(static_cast<double>(sums[0]), static_cast<double>(-0x1p35L * little));
  EXPECT_EQ(static_cast<double>(sums[1]), static_cast<double>(0x1p35L * little));
  Eigen::SparseMatrix<double, Eigen::RowMajor, int> b(1, 2);
  b.insert(0, 1) = 2;
  subtract_transposed_product(b, Eigen::VectorXd::Constant(1, 0x1p-70), sums);
  EXPECT_EQ(static_cast<double>(sums[0]), static_cast<double>(-0x1p35L * little));
  EXPECT_EQ(static_cast<double>(sums[1]), static_cast<double>(0x1p35L * little - 0x1p-69L));
}

}  // namespace
}  // namespace mortise
