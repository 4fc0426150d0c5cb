// Q R against the columns it was made of: columns that are zero or others' sums, and columns that are nearly alike.
#include "../src/orthonormal_columns.hpp"

#include <gtest/gtest.h>

#include "dense_operator.hpp"

namespace mortise::qp {
namespace {

constexpr int length_of_columns = 60;

Eigen::VectorXd wave(double k)
{
  Eigen::VectorXd result(length_of_columns);
  for (int i = 0; i < length_of_columns; ++i) result[i] = std::sin(1 + k * k + 0.7 * k * i);
  return result.normalized();
}

// Of `v`, its rows spread over the ranks: Q'Q = I, and Q R = the columns that are kept.
OrthonormalColumns expect_orthonormal(const Eigen::MatrixXd& v)
{
  const Communicator comm;
  const auto map = even_map(length_of_columns, comm);
  Eigen::MatrixXd own(static_cast<Eigen::Index>(map->getNodeNumElements()), v.cols());
  for (Eigen::Index i = 0; i < own.rows(); ++i)
    own.row(i) = v.row(static_cast<Eigen::Index>(map->getGlobalElement(static_cast<Local>(i))));
  const auto result = orthonormal_columns(own, 1e-3, comm);
  const auto count = static_cast<Eigen::Index>(result.kept.size());
  Eigen::MatrixXd gram = result.q.transpose() * result.q;
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(count, count)).norm(), 1e-7);
  EXPECT_TRUE(result.r.isUpperTriangular(0));
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto j = result.kept[static_cast<std::size_t>(k)];
    EXPECT_LT((result.q * result.r.col(k) - own.col(j)).norm(), 1e-10 * v.col(j).norm()) << j;
  }
  return result;
}

TEST(OrthonormalColumns, LeavesOutWhatIsNotNew)
{
  Eigen::MatrixXd v(length_of_columns, 6);
  v << wave(1), 1e6 * wave(2), Eigen::VectorXd::Zero(length_of_columns), 3 * wave(1) - wave(2) + 1e-4 * wave(3), 1e-9 * wave(4),
      wave(1) + 1e-2 * wave(5);
  EXPECT_EQ(expect_orthonormal(v).kept, (std::vector<Eigen::Index>{0, 1, 4, 5}));
}

// Each column is new by three thousandths beside those before it, so that their condition grows a hundredfold from one to the
// next. Without the fourth, which makes it too large, those after it are new by what that one had.
TEST(OrthonormalColumns, AreOrthonormalWhereColumnsAreAlike)
{
  Eigen::MatrixXd waves(length_of_columns, 8);
  for (int j = 0; j < 8; ++j) waves.col(j) = wave(j + 1);
  const Eigen::MatrixXd q = waves.householderQr().householderQ() * Eigen::MatrixXd::Identity(length_of_columns, 8);
  Eigen::MatrixXd v(length_of_columns, 8);
  v.col(0) = q.col(0);
  for (int j = 1; j < 8; ++j) v.col(j) = 1e3 * (q.leftCols(j).rowwise().sum().normalized() + 3e-3 * q.col(j));
  EXPECT_EQ(expect_orthonormal(v).kept, (std::vector<Eigen::Index>{0, 1, 2, 4, 5, 6, 7}));
}

// A rank may have no multipliers.
TEST(OrthonormalColumns, RowsMayBeOnOneRankAlone)
{
  const Communicator comm;
  Eigen::MatrixXd v(length_of_columns, 2);
  v << wave(1), wave(1) + wave(2);
  if (comm.rank() > 0) v.resize(0, 2);
  const auto result = orthonormal_columns(v, 1e-3, comm);
  EXPECT_EQ(result.kept, (std::vector<Eigen::Index>{0, 1}));
  EXPECT_LT((result.q * result.r - v).norm(), 1e-12);
  EXPECT_EQ(result.q.rows(), v.rows());
}

TEST(OrthonormalColumns, OfNoneAreNone)
{
  EXPECT_TRUE(expect_orthonormal(Eigen::MatrixXd(length_of_columns, 0)).kept.empty());
}

}  // namespace
}  // namespace mortise::qp
