// The coarse matrix against G D G' formed densely, both where it eliminates rows and where all of them are touched.
#include "qp/coarse_matrix.hpp"

#include <gtest/gtest.h>

#include "dense_operator.hpp"

namespace mortise::qp {
namespace {

TEST(CoarseMatrix, SolvesWhatBlocksLeave)
{
  const Communicator comm;
  constexpr int n = 40, rows = 8;
  const auto map = even_map(n, comm);
  // Row r of G lives on the unknowns 5 r .. 5 r + 9, so that constraints on the first few touch few rows.
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(rows, n);
  for (int r = 0; r < rows; ++r)
    for (int k = 0; k < 10; ++k) g(r, (5 * r + k) % n) = std::sin(1.0 + r * 10 + k);
  for (const int constrained : {0, 7, n}) {
    Eigen::MatrixXd d = Eigen::MatrixXd::Identity(n, n);
    std::vector<Local> unknowns;
    std::vector<LostBlock> lost;
    for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i)
      if (map->getGlobalElement(i) < constrained) unknowns.push_back(i);
    for (int i = 0; i < constrained; i += 3) d(i, i) = 0.3;
    for (const Local i : unknowns)
      if (map->getGlobalElement(i) % 3 == 0) {
        lost.emplace_back().index[0] = i;
        lost.back().matrix(0, 0) = 0.7;
      }
    const EqualityConstraint equality(local_columns(g, *map), Eigen::VectorXd::Ones(rows), comm);
    CoarseMatrix matrix(equality, unknowns);
    EXPECT_EQ(matrix.touched(), constrained == 0 ? 0 : constrained == 7 ? 3 : rows);
    ASSERT_TRUE(matrix.factorize(lost, 0));
    const Eigen::VectorXd r = Eigen::VectorXd::LinSpaced(rows, -1, 2);
    const Eigen::VectorXd expected = (g * d * g.transpose()).ldlt().solve(r);
    EXPECT_LT((matrix.solve(r) - expected).norm(), 1e-11 * expected.norm()) << constrained;
  }
}

}  // namespace
}  // namespace mortise::qp
