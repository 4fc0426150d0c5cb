// How far bodies that a solution leaves open return to where they were drawn.
#include "../src/neutral_motions.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace mortise::feti {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

// Rows on the last rank, the amplitudes on all.
FeltMotions felt(const Eigen::MatrixXd& rows, const VectorXd& closed, const VectorXd& gap, const Communicator& comm)
{
  if (comm.rank() + 1 == comm.size()) return {SparseMatrix(rows.sparseView()), closed, gap};
  return {SparseMatrix(0, rows.cols()), VectorXd(0), VectorXd(0)};
}

constexpr double none = std::numeric_limits<double>::infinity();

TEST(NeutralMotions, ABodyReturnsAsFarAsAGapLetsIt)
{
  const Communicator comm;
  const Vector2d now(27, 3), closed(1, 0), gap(none, 26.9);
  const auto way = towards_rest(felt(Eigen::Matrix2d{{0, 1}, {-1, 0}}, closed, gap, comm), now, comm);
  EXPECT_NEAR(way[0], -26.9, 1e-12);
  EXPECT_NEAR(way[1], 0, 1e-12);  // felt by a row that holds
}

TEST(NeutralMotions, ItGoesOnBesideWhatStopsIt)
{
  const Communicator comm;
  const Vector2d now(10, 10);
  const auto way = towards_rest(felt(Eigen::RowVector2d(-1, 0), VectorXd::Zero(1), VectorXd::Constant(1, 4.0), comm), now, comm);
  EXPECT_NEAR(way[0], -4, 1e-12);
  EXPECT_NEAR(way[1], -10, 1e-12);
}

TEST(NeutralMotions, NothingMovesThroughAGapThatIsClosed)
{
  const Communicator comm;
  const Vector2d now(10, 0);
  const auto way = towards_rest(felt(Eigen::RowVector2d(-1, 0), VectorXd::Zero(1), VectorXd::Zero(1), comm), now, comm);
  EXPECT_NEAR(way.norm(), 0, 1e-12);
}

TEST(NeutralMotions, WhatTurnsWhereItIsDoesNotTravelNorWhatNoLoadDrives)
{
  Bodies bodies;
  bodies.kinematics = fem::Kinematics::plane_strain;
  bodies.modes = 3;
  bodies.frames.resize(3);
  VectorXd change(9);
  change << 0.02, 0, 0.5, 0, -0.3, 0.01, 1e-8, 0, 0;  // the last is rounding
  bodies.force = Eigen::Vector3d(0, 2, 100);
  bodies.generalised = VectorXd::Unit(9, 4);  // half of the force on the second body drives it
  EXPECT_EQ(travellers(change, bodies), (std::vector<bool>{false, true, false}));
  bodies.generalised =
      VectorXd::Unit(9, 3) + 1e-9 * VectorXd::Unit(9, 4) + VectorXd::Unit(9, 6);  // across its way, but for rounding
  EXPECT_EQ(travellers(change, bodies), (std::vector<bool>{false, false, false}));
}

TEST(NeutralMotions, AForceIsLittleBesideThoseOnTheLighterBody)
{
  const Communicator comm;
  // Two bodies that move along a line, each on the ground, and one on the other; a row that feels none, as that of a ring.
  const auto rows = felt(Eigen::Matrix<double, 4, 2>{{1, 0}, {1, -1}, {0, 1}, {0, 0}}, {}, {}, comm).rows;
  const VectorXd forces = rows.rows() == 4 ? VectorXd(Eigen::Vector4d(100, 1e-3, 2, 50)) : VectorXd(0);
  const VectorXd largest = largest_on_bodies(rows, forces, {false, false}, comm);
  const VectorXd without = largest_on_bodies(rows, forces, {false, true}, comm);
  if (rows.rows() == 0) return;
  EXPECT_EQ(largest, Eigen::Vector4d(100, 2, 2, 0));
  EXPECT_EQ(without, Eigen::Vector4d(100, 0, 0, 0));
}

}  // namespace
}  // namespace mortise::feti
