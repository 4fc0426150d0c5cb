// The coarse matrix against G D G' formed densely: few touched rows and all, by the Schur complement and sparsely.
#include "qp/coarse_matrix.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "dense_operator.hpp"

namespace mortise::qp {
namespace {

constexpr int unknowns = 40, rows = 8;

// Row r of G lives on the unknowns 5 r .. 5 r + 9, so that constraints on the first few touch few rows.
Eigen::MatrixXd staggered()
{
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(rows, unknowns);
  for (int r = 0; r < rows; ++r)
    for (int k = 0; k < 10; ++k) g(r, (5 * r + k) % unknowns) = std::sin(1.0 + r * 10 + k);
  return g;
}

// The solution of (G D G') x = r against Eigen's.
void expect_solved(const Eigen::MatrixXd& g, const Eigen::MatrixXd& d, const std::optional<CoarseMatrix::Factor>& factor)
{
  ASSERT_TRUE(factor);
  const Eigen::VectorXd r = Eigen::VectorXd::LinSpaced(rows, -1, 2);
  const Eigen::VectorXd expected = (g * d * g.transpose()).ldlt().solve(r);
  EXPECT_LT((factor->solve(r) - expected).norm(), 1e-11 * expected.norm());
}

class Coarse : public testing::TestWithParam<int> {};

TEST_P(Coarse, SolvesWhatConstraintsLeave)
{
  const Communicator comm;
  const auto map = even_map(unknowns, comm);
  const auto g = staggered();
  for (const int constrained : {0, 7, unknowns}) {
    Eigen::MatrixXd d = Eigen::MatrixXd::Identity(unknowns, unknowns);
    for (int i = 0; i < constrained; i += 3) d(i, i) = 0.3;
    std::vector<BlockIndex> blocks;
    std::vector<DowndateBlock> downdates;
    for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i) {
      if (map->getGlobalElement(i) >= constrained) continue;
      blocks.push_back({i, -1, -1});
      if (map->getGlobalElement(i) % 3 != 0) continue;
      downdates.emplace_back().index[0] = i;
      downdates.back().matrix(0, 0) = 0.7;
    }
    const EqualityConstraint equality(local_columns(g, *map), comm);
    CoarseMatrix matrix(equality, blocks, GetParam());
    EXPECT_EQ(matrix.touched(), constrained == 0 ? 0 : constrained == 7 ? 3 : rows);
    for (int time = 0; time < 2; ++time) {  // nothing of the first stays
      expect_solved(g, d, matrix.factorize(downdates, 0));
    }
    expect_solved(g, Eigen::MatrixXd::Identity(unknowns, unknowns), matrix.factorize({}, 0));
  }
}

// Two unknowns of one disc that no row of G joins: the block joins rows that are apart in G G'.
TEST_P(Coarse, BlockJoinsRowsThatAreApart)
{
  const Communicator comm;
  const auto map = even_map(unknowns, comm);
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(rows, unknowns);
  for (int r = 0; r < rows; ++r) g.row(r).segment(5 * r, 5).setLinSpaced(1, 2 + r);
  g(0, 1) = 0;
  g(1, 0) = 1;  // row 0 has unknown 0, row 2 unknown 1
  g(2, 1) = 3;
  Eigen::Matrix2d block;
  block << 0.5, 0.2, 0.2, 0.6;
  Eigen::MatrixXd d = Eigen::MatrixXd::Identity(unknowns, unknowns);
  d.topLeftCorner(2, 2) -= block;
  std::vector<BlockIndex> blocks;
  std::vector<DowndateBlock> downdates;
  if (const Local i = map->getLocalElement(0); comm.root()) {
    blocks.push_back({i, i + 1, -1});
    auto& entry = downdates.emplace_back();
    entry.index = {i, i + 1, -1};
    entry.matrix.topLeftCorner<2, 2>() = block;
  }
  const EqualityConstraint equality(local_columns(g, *map), comm);
  CoarseMatrix matrix(equality, blocks, GetParam());
  EXPECT_EQ(matrix.touched(), 3);
  expect_solved(g, d, matrix.factorize(downdates, 0));
}

// A sparse factor gives its memory to the next one; dense ones stand side by side.
TEST_P(Coarse, AFactorWhoseMemoryWasTakenIsRefused)
{
  const Communicator comm;
  const auto map = even_map(unknowns, comm);
  const auto g = staggered();
  std::vector<BlockIndex> blocks;
  std::vector<DowndateBlock> downdates;
  for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i) {
    blocks.push_back({i, -1, -1});
    downdates.emplace_back().index[0] = i;
    downdates.back().matrix(0, 0) = 0.7;
  }
  const EqualityConstraint equality(local_columns(g, *map), comm);
  CoarseMatrix matrix(equality, blocks, GetParam());
  const auto first = matrix.factorize(downdates, 0), second = matrix.factorize({}, 0);
  expect_solved(g, Eigen::MatrixXd::Identity(unknowns, unknowns), second);
  if (GetParam() == 0)
    EXPECT_THROW(first->solve(Eigen::VectorXd::Ones(rows)), std::logic_error);
  else
    expect_solved(g, 0.3 * Eigen::MatrixXd::Identity(unknowns, unknowns), first);
}

// All by the Schur complement, and all sparsely but where nothing is touched.
INSTANTIATE_TEST_SUITE_P(DenseAndSparse, Coarse, testing::Values(rows, 0));

}  // namespace
}  // namespace mortise::qp
