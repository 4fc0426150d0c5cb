// Rows of single nodes: node to segment, and rigid obstacles.
#include <gtest/gtest.h>

#include <cmath>

#include "contact/obstacle.hpp"
#include "surfaces.hpp"

namespace mortise::contact {
namespace {

TEST(NodeToSegment, LinearFieldsPassAndMatchingMeshesGivePairs)
{
  const Communicator comm;
  const auto plane = [](double x, double y) { return Point(x, y, 0.3 * x - 0.2 * y); };
  auto pair = make_pair(surface({5, 4, 0, 1, 0, 1, true, false, 0, 0.2}, plane, comm),
                        surface({3, 7, 0, 1, 0, 1, false, true, primary_ids, 0.2}, plane, comm), Law::bonded);
  pair.options.discretization = "node_to_segment";
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  ASSERT_EQ(rows.rows.size(), 3U * 30U);
  Eigen::Matrix3d gradient;
  gradient << 1, 2, 3, -1, 0.5, 2, 0.3, -2, 1;
  const auto nodes = nodes_of(pair, comm);
  double area = 0;
  for (const auto& row : rows.rows) {
    double jump = 0;
    int own = 0;
    for (const auto& e : row.entries) {
      jump += e.coefficient * (gradient * nodes.at(e.node) + Point(1, 2, 3))[e.component];
      if (e.node < primary_ids) own += e.node == row.node ? 1 : 100;
    }
    EXPECT_NEAR(jump, 0, 1e-12);
    EXPECT_LE(own, 3);
    if (row.is_normal) area += row.area;
  }
  EXPECT_NEAR(area, std::sqrt(1 + 0.09 + 0.04), 1e-10);

  auto matching = make_pair(surface({4, 4, 0, 1, 0, 1, true}, plane, comm),
                            surface({4, 4, 0, 1, 0, 1, false, false, primary_ids}, plane, comm), Law::tresca);
  matching.options.discretization = "node_to_segment";
  const auto places = nodes_of(matching, comm);
  const auto pairs = gather_rows(discretize(std::vector<Pair>{matching}, {}, fem::Kinematics::solid, comm), comm);
  EXPECT_EQ(pairs.rows.size(), 3U * 25U);
  for (const auto& row : pairs.rows)
    for (const auto& e : row.entries)
      EXPECT_TRUE(std::abs(e.coefficient) < 1e-12 || (places.at(e.node) - places.at(row.node)).norm() < 1e-12);
}

TEST(Obstacles, SignedDistances)
{
  using Shape = Obstacle::Shape;
  const Point x(3, 4, 7);
  EXPECT_NEAR(signed_distance({Shape::plane, Point(0, 0, 5), Point::UnitZ(), 0, false}, x).distance, 2, 1e-15);
  EXPECT_NEAR(signed_distance({Shape::cylinder, Point::Zero(), Point::UnitZ(), 4, false}, x).distance, 1, 1e-15);
  EXPECT_NEAR(signed_distance({Shape::cylinder, Point::Zero(), Point::UnitZ(), 4, true}, x).distance, -1, 1e-15);
  EXPECT_LT((signed_distance({Shape::cylinder, Point::Zero(), Point::UnitZ(), 4, true}, x).normal + Point(0.6, 0.8, 0)).norm(),
            1e-15);
  EXPECT_NEAR(signed_distance({Shape::sphere, Point(0, 0, 7), Point::UnitY(), 6, true}, x).distance, 1, 1e-15);
  EXPECT_LT((signed_distance({Shape::sphere, Point(0, 0, 7), Point::UnitY(), 6, false}, x).normal - Point(0.6, 0.8, 0)).norm(),
            1e-15);
  EXPECT_FALSE(std::isfinite(signed_distance({Shape::sphere, x, Point::UnitY(), 6, false}, x).distance));
  // Along a line: to a plane, into a cylinder and a sphere, out of a hollow one, past both.
  const Point down = Point(3, 0, -4) / 5;
  EXPECT_NEAR(distance_along({Shape::plane, Point(0, 0, 5), Point::UnitZ(), 0, false}, x, down), 2.5, 1e-14);
  EXPECT_NEAR(distance_along({Shape::cylinder, Point(13, 4, 0), Point::UnitZ(), 4, false}, x, down), 10, 1e-13);
  EXPECT_NEAR(distance_along({Shape::cylinder, Point(3, 4, 0), Point::UnitZ(), 3, true}, x, down), 5, 1e-13);
  EXPECT_NEAR(distance_along({Shape::sphere, x + 10 * down, Point::UnitY(), 4, false}, x, down), 6, 1e-13);
  EXPECT_NEAR(distance_along({Shape::sphere, x + 3 * down, Point::UnitY(), 4, false}, x, down), -1, 1e-13);
  EXPECT_NEAR(distance_along({Shape::sphere, x - 3 * down, Point::UnitY(), 4, true}, x, down), 1, 1e-13);
  EXPECT_FALSE(std::isfinite(distance_along({Shape::sphere, x - 10 * down, Point::UnitY(), 4, false}, x, down)));
  EXPECT_FALSE(std::isfinite(distance_along({Shape::sphere, x + 10 * Point::UnitY(), Point::UnitY(), 4, false}, x, down)));
}

// A wavy sheet over a plane: rows of single nodes along the plane's normal, with their heights for gaps; areas of the whole
// sheet.
TEST(Obstacles, RowsAreThoseOfNodesAlongTheNormalOfTheObstacle)
{
  const Communicator comm;
  const auto sheet = [](double x, double y) { return Point(x, y, 0.1 * x * x + 0.05 * y); };
  auto pair = make_pair(surface({5, 4, 0, 1, 0, 1, false, false, 0, 0.2}, sheet, comm), {}, Law::coulomb);
  pair.primary = nullptr;
  pair.options.obstacle = Obstacle{Obstacle::Shape::plane, Point(7, 8, -0.01), Point::UnitZ(), 0, false};
  pair.options.interference = 0.005;
  const auto contacts = discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(contacts.nodes.size())), 30);
  std::vector<double> area{0};
  for (const auto& point : contacts.nodes) {
    EXPECT_LT((point.normal + Point::UnitZ()).norm(), 1e-15);
    EXPECT_NEAR(point.gap, point.at[2] + 0.01 - 0.005, 1e-14);
    ASSERT_EQ(contacts.rows[point.row].size(), 1U);
    EXPECT_EQ(contacts.rows[point.row][0].node, point.node);
    EXPECT_NEAR(contacts.rows[point.row][0].coefficient, -1, 1e-12);
    area[0] += point.area;
  }
  comm.sum_in_place(area);
  // integral sqrt(1 + (0.2 x)^2 + 0.05^2), x in [0, 1]; facets are smaller by about a twentieth of a per cent.
  EXPECT_NEAR(area[0], 1.00778, 5e-4);
}

// A belt round a drum whose end lies on it and is drawn along it: the place that is prescribed has no row, as nothing is left to
// move there, and its neighbours see no part of its motion, which seen along their normals goes into the drum.
TEST(Obstacles, AnEndThatIsDrawnAlongADrumIsNoOverlapToItsNeighbours)
{
  const Communicator comm;
  const auto drum = [](double x, double y) { return Point(std::cos(x), std::sin(x), y); };
  auto pair = make_pair(surface({6, 2, 0, 1.5, 0, 1, false}, drum, comm), {}, Law::coulomb);
  pair.primary = nullptr;
  pair.options.obstacle = Obstacle{Obstacle::Shape::cylinder, Point::Zero(), Point::UnitZ(), 1, false};
  std::vector<constraint::PrescribedDof> prescribed;
  if (comm.root())
    for (const Global node : {0, 7, 14})
      for (const int component : {0, 1, 2})
        prescribed.push_back({node, component, component == 1 ? -0.1 : 0.0, static_cast<int>(node)});
  const auto contacts = discretize(std::vector<Pair>{pair}, prescribed, fem::Kinematics::solid, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(contacts.nodes.size())), 18);
  for (const auto& point : contacts.nodes) {
    EXPECT_NE(point.node % 7, 0);
    EXPECT_NEAR(contacts.rows.bound[point.row], 0, 1e-12) << "node " << point.node;
  }
}

}  // namespace
}  // namespace mortise::contact
