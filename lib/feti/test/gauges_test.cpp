// Sparse matrices with gauges over whole bodies, against the equations with all their entries.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include "../src/whole_problem.hpp"

namespace mortise::feti {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index order = 14, joints = 3, motions = 2;  // unknowns, rows of B, gauges

// A body with two free motions V: K V = 0, B V = 0; the last rows of B are gauges V'D.
struct FreeBody {
  MatrixXd v, k, b;
  VectorXd load, bounds;

  FreeBody()
  {
    std::srand(3);
    v = MatrixXd(MatrixXd::Random(order, motions).householderQr().householderQ()).leftCols(motions);
    const MatrixXd still = MatrixXd::Identity(order, order) - v * v.transpose(), any = MatrixXd::Random(order, order);
    k = still * (any * any.transpose() + MatrixXd::Identity(order, order)) * still;
    b.resize(joints + motions, order);
    b.topRows(joints) = MatrixXd::Random(joints, order) * still;
    const VectorXd weights = VectorXd::Random(order).cwiseAbs().array() + 1;
    b.bottomRows(motions) = v.transpose() * weights.asDiagonal();
    load = still * VectorXd::Random(order);
    bounds = VectorXd::Random(joints + motions);
  }

  VectorXd solution() const  // u, then x
  {
    const Eigen::Index rows = joints + motions;
    MatrixXd all = MatrixXd::Zero(order + rows, order + rows);
    all.topLeftCorner(order, order) = k;
    all.topRightCorner(order, rows) = b.transpose();
    all.bottomLeftCorner(rows, order) = b;
    VectorXd right(order + rows);
    right << load, bounds;
    return all.partialPivLu().solve(right);
  }
};

TEST(Gauges, ArePinsUntilTheSolutionIsThere)
{
  const FreeBody body;
  SupportElimination::Rows rows = body.b.sparseView();
  const Gauges gauges(rows, body.v.sparseView());
  for (Eigen::Index k = joints; k < rows.rows(); ++k) EXPECT_EQ(rows.row(static_cast<int>(k)).nonZeros(), 1);
  EXPECT_LT((MatrixXd(rows.topRows(joints)) - body.b.topRows(joints)).norm(), 1e-15);

  const SupportElimination elimination(rows, VectorXd::Zero(rows.rows()), {{}, {}});
  EXPECT_EQ(elimination.kept().size(), static_cast<std::size_t>(joints));
  const SparseMatrix lower = MatrixXd(body.k.triangularView<Eigen::Lower>()).sparseView();
  WholeProblem whole(lower, elimination, false);
  auto found = whole.solve(body.load, body.bounds, {{}, {}});
  ASSERT_TRUE(found.converged);
  gauges.restore(body.bounds, found.x, found.u);
  const VectorXd expected = body.solution();
  EXPECT_LT((found.u - expected.head(order)).norm(), 1e-9 * expected.head(order).norm());
  EXPECT_LT((found.x - expected.tail(joints + motions)).norm(), 1e-9 * expected.tail(joints + motions).norm());
}

// What drives a free motion is answered by the gauges with the same work, wherever they act.
TEST(Gauges, BearWhatDrivesTheirMotions)
{
  FreeBody body;
  body.load += 1e-3 * body.v.col(0) - 2e-3 * body.v.col(1);
  SupportElimination::Rows rows = body.b.sparseView();
  const Gauges gauges(rows, body.v.sparseView());
  const SupportElimination elimination(rows, VectorXd::Zero(rows.rows()), {{}, {}});
  WholeProblem whole(MatrixXd(body.k.triangularView<Eigen::Lower>()).sparseView(), elimination, false);
  auto found = whole.solve(body.load, body.bounds, {{}, {}});
  gauges.restore(body.bounds, found.x, found.u);
  const VectorXd work = body.v.transpose() * (body.load - body.b.transpose() * found.x);
  EXPECT_LT(work.norm(), 1e-12);
  EXPECT_LT((body.b.bottomRows(motions) * found.u - body.bounds.tail(motions)).norm(), 1e-12);
}

}  // namespace
}  // namespace mortise::feti
