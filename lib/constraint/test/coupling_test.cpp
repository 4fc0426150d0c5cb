#include "constraint/coupling.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "constraint/supports.hpp"
#include "nodes.hpp"

namespace mortise::constraint {
namespace {

// A unit square in z = 0, seen by every rank.
mesh::Surface square(Global first)
{
  mesh::Surface surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (Global n = 0; n < 4; ++n) surface.node_id.push_back(first + n);
  return surface;
}

Coupling coupling(const std::string& name)
{
  Coupling result;
  result.name = name;
  result.rigid = true;
  result.point = {0, 0, 2};
  result.arm = 2.5;
  return result;
}

TEST(Couplings, NodesFollowWhatIsPrescribedOfThePoint)
{
  const Communicator comm;
  auto rigid = coupling("cap");
  rigid.motion = {0.1, 0.2, 0.3, 0.01, 0.02, 0.04};
  const auto rows = coupled_rows(std::vector{rigid}, std::vector{square(10)}, 7, 3, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(rows.size())), 12);
  for (const auto& row : rows) {
    EXPECT_EQ(row.node % comm.size(), comm.rank());
    EXPECT_EQ(row.support, 7);
    EXPECT_FALSE(row.unknown);
    const Point x = square(10).points[static_cast<std::size_t>(row.node - 10)];
    const Point u = Point(0.1, 0.2, 0.3) + Point(0.01, 0.02, 0.04).cross(Point(x - rigid.point));
    EXPECT_NEAR(row.value, u[row.component], 1e-15);
  }
  Constraints constraints;
  constraints.prescribed = rows;
  constraints.couplings = {rigid};
  EXPECT_TRUE(unknown_motions(constraints, 3).empty());
}

TEST(Couplings, RowsGiveWayToWhatIsUnknown)
{
  const Communicator comm;
  auto rigid = coupling("cap");
  rigid.motion = {0.1, {}, 0.3, 0.0, 0.0, {}};  // free along y and about z
  rigid.load = {0, 5, 0, 0, 0, 8};
  Constraints constraints;
  constraints.prescribed = coupled_rows(std::vector{rigid}, std::vector{square(10)}, 0, 3, comm);
  constraints.couplings = {rigid};
  for (const auto& row : constraints.prescribed) EXPECT_EQ(row.unknown, row.component != 2);
  const auto motions = unknown_motions(constraints, 3);
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_EQ(motions[0].component, 1);
  EXPECT_EQ(motions[0].force, 5);
  EXPECT_EQ(motions[1].component, 5);
  EXPECT_EQ(motions[1].force, 8 / 2.5);
  // The displacement of every node for U_y = 0.7 and T_z = 0.03.
  const double s[] = {0.7, 0.03 * 2.5};
  std::vector<double> u;
  for (const auto& row : constraints.prescribed) u.push_back(row.value);
  for (std::size_t k = 0; k < 2; ++k)
    for (const auto& [row, part] : motions[k].rows) u[row] += part * s[k];
  for (std::size_t r = 0; r < u.size(); ++r) {
    const auto& row = constraints.prescribed[r];
    const Point x = square(10).points[static_cast<std::size_t>(row.node - 10)];
    const Point exact = Point(0.1, 0.7, 0.3) + Point(0, 0, 0.03).cross(Point(x - rigid.point));
    EXPECT_NEAR(u[r], exact[row.component], 1e-15);
  }
}

TEST(Couplings, InAPlaneAPointTurnsAboutZAlone)
{
  const Communicator comm;
  auto rigid = coupling("cap");
  rigid.point = {0, 0, 0};
  Constraints constraints;
  constraints.prescribed = coupled_rows(std::vector{rigid}, std::vector{square(10)}, 0, 2, comm);
  constraints.couplings = {rigid};
  EXPECT_EQ(comm.sum(static_cast<long long>(constraints.prescribed.size())), 8);
  EXPECT_EQ(unknown_motions(constraints, 2).size(), 3U);
}

TEST(Couplings, TwoThatShareNodesAreRefused)
{
  const Communicator comm;
  const std::vector both{coupling("cap"), coupling("grip")};
  try {
    coupled_rows(both, std::vector{square(10), square(13)}, 0, 3, comm);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    EXPECT_NE(std::string(error.what()).find("\"cap\" and \"grip\""), std::string::npos);
  }
}

TEST(Couplings, ASupportIsRefusedWhereTheMotionIsUnknown)
{
  const Communicator comm;
  const std::vector<Support> supports{{"side", {0.0, std::nullopt, std::nullopt}}, {"coupling cap", {}}};
  const auto nodes = anywhere({{10, 13}, {}});
  auto rigid = coupling("cap");
  const auto rows = [&] { return coupled_rows(std::vector{rigid}, std::vector{square(10)}, 1, 3, comm); };
  EXPECT_THROW(dirichlet_rows(supports, nodes, 3, comm, rows()), Error);
  rigid.motion = {0.0, {}, {}, {}, 0.0, 0.0};  // as on a plane of symmetry: what the support says of x is known already
  EXPECT_EQ(comm.sum(static_cast<long long>(dirichlet_rows(supports, nodes, 3, comm, rows()).size())), 12);
}

}  // namespace
}  // namespace mortise::constraint
