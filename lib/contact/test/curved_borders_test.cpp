#include "surface/curved_borders.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/communicator.hpp"
#include "surface/beside_border.hpp"
#include "surface/kinks.hpp"
#include "surfaces.hpp"

namespace mortise::contact {
namespace {

// Faces of second order with all their nodes on z(x), over a grid.
template <class Height>
Side curved(const Grid& grid, mesh::CellType type, const Height& height, const Communicator& comm)
{
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  auto whole = second_order(surface(grid, flat, comm), type, Eigen::Matrix3d::Identity(), grid.first_id);
  for (auto& x : whole.points) x[2] = height(x[0]);
  return gather(whole, fem::Kinematics::solid, comm);
}

const auto types = {mesh::CellType::quad8, mesh::CellType::quad9, mesh::CellType::tri6};

TEST(CurvedBorders, WavesOfThreeFacesAndMoreHaveNoKinks)
{
  const Communicator comm;
  for (const auto type : types)
    for (const int faces : {3, 4, 6, 7, 8, 10})
      for (double phase = 0; phase < 6; phase += 0.35) {
        const double harmonic = faces > 5 ? 0.02 : 0;  // of half the length: then no three faces a wave
        const auto wave = [&](double x) {
          const double angle = 2 * std::numbers::pi * x + phase;
          return 0.05 * std::cos(angle) + harmonic * std::sin(2 * angle);
        };
        auto side = curved({2 * faces, 4, 0, 2, 0, 4.0 / faces, true, type == mesh::CellType::tri6}, type, wave, comm);
        find_kinks(side);
        EXPECT_TRUE(side.kinks.empty()) << faces << " faces, " << side.kinks.size() << " kinks, phase " << phase;
      }
}

// Both arcs turn by 5 degrees a face.
TEST(CurvedBorders, ArcsThatMeetAtAnAngleHaveAKinkThere)
{
  const Communicator comm;
  for (const auto type : types)
    for (const double degrees : {3.0, 8.0, 20.0})
      for (const double sense : {1.0, -1.0}) {
        const double slope = std::tan(degrees / 2 * std::numbers::pi / 180);
        const auto arcs = [&](double x) { return sense * (std::sqrt(9 - x * x) - slope * std::abs(x)); };
        auto side = curved({8, 3, -1, 1, 0, 1, true, type == mesh::CellType::tri6}, type, arcs, comm);
        find_kinks(side);
        EXPECT_EQ(side.kinks.size(), 6U) << degrees << " degrees";  // halves of three edges
        for (const auto& edge : side.kinks)
          for (const Local n : edge) EXPECT_NEAR(side.points[static_cast<std::size_t>(n)][0], 0, 1e-12);
      }
}

// There one side of a kink says nothing. The arcs turn by 5 degrees a face.
TEST(CurvedBorders, KinksOneFaceFromABorderOrFromEachOtherAreFound)
{
  const Communicator comm;
  constexpr double face = 0.25;
  for (const auto type : types)
    for (const double degrees : {6.0, 8.0, 20.0})
      for (const bool two : {false, true}) {
        const double slope = std::tan(degrees / 2 * std::numbers::pi / 180);
        const auto arcs = [&](double x) {
          return std::sqrt(9 - x * x) - slope * std::abs(x) - (two ? slope * std::abs(x - face) : 0);
        };
        const int before = two ? 3 : 1, faces = before + 4;
        const bool triangles = type == mesh::CellType::tri6;
        auto side = curved({faces, 3, -before * face, 4 * face, 0, 3 * face, true, triangles}, type, arcs, comm);
        find_kinks(side);
        EXPECT_EQ(side.kinks.size(), two ? 12U : 6U) << degrees << " degrees";
        for (const auto& edge : side.kinks)
          for (const Local n : edge) {
            const double x = side.points[static_cast<std::size_t>(n)][0];
            EXPECT_TRUE(std::abs(x) < 1e-12 || (two && std::abs(x - face) < 1e-12)) << x;
          }
      }
}

// Of an arc that ends at 80 degrees to a plane; one that ends at a right angle goes on in it.
TEST(CurvedBorders, AnArcMeetsItsImageAtAKinkUnlessItEndsAtARightAngle)
{
  const Communicator comm;
  for (const auto type : types)
    for (const double tilt : {0.0, 10.0, -10.0}) {
      const double slope = std::tan(tilt * std::numbers::pi / 180);
      const auto arc = [&](double x) { return std::sqrt(9 - x * x) + slope * x; };
      const auto side = curved({4, 3, 0, 1, 0, 1, true, type == mesh::CellType::tri6}, type, arc, comm);
      const CurvedBorders borders(side);
      int count = 0;
      for (const auto& edge : borders.edges()) {
        const auto at = [&](Local n) { return side.points[static_cast<std::size_t>(n)][0]; };
        if (at(edge.a) != 0 || at(edge.b) != 0) continue;
        ++count;
        EXPECT_EQ(borders.meets_image_at_kink(edge, Point::UnitX()), tilt != 0) << tilt;
        EXPECT_EQ(edge.parts.size(), 2U);
      }
      EXPECT_EQ(count, 3);
    }
}

TEST(CurvedBorders, NodesFollowTheirNeighboursAlongABorder)
{
  using enum GoesOn;
  const std::vector<FacetEdge> line{{0, 1}, {2, 1}, {2, 3}, {3, 4}, {1, 0}};  // one twice, one the other way
  const auto after = [&](std::vector<GoesOn> nodes) {
    follow_neighbours(line, nodes);
    return nodes;
  };
  EXPECT_EQ(after({yes, no, yes, yes, yes}), (std::vector{yes, yes, yes, yes, yes}));
  EXPECT_EQ(after({no, no, yes, no, no}), (std::vector{no, no, no, no, no}));
  EXPECT_EQ(after({no, yes, yes, yes, not_asked}), (std::vector{no, yes, yes, yes, not_asked}));  // equal votes
  EXPECT_EQ(after({no, no, no, yes, yes}), (std::vector{no, no, no, yes, yes}));
}

}  // namespace
}  // namespace mortise::contact
