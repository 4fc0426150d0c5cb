// Directions and gaps of curved sides do not depend on how they are cut into faces.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

struct Errors {
  double direction = 0, gap = 0;
};

// Of two sides `apart` from each other, n x n faces and some more of 1.4 x 1.4: directions beside `normal` of the secondary nodes
// x, and gaps. Inner nodes are moved by a quarter of a face.
template <class Below, class Above, class Normal>
Errors errors(const Below& below, const Above& above, const Normal& normal, double apart, int n, bool triangles)
{
  const Communicator comm;
  auto pair = make_pair(surface({n, n, -0.7, 0.7, -0.7, 0.7, true, triangles, 0, 0.25}, below, comm),
                        surface({n + 2, n + 1, -0.7, 0.7, -0.7, 0.7, false, triangles, primary_ids, 0.25}, above, comm),
                        Law::frictionless);
  const auto nodes = nodes_of(pair, comm);
  Errors worst;
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  EXPECT_GE(rows.rows.size(), static_cast<std::size_t>(n * n));
  for (const auto& row : rows.rows) {
    worst.direction = std::max(worst.direction, (row.normal - normal(nodes.at(row.node))).norm());
    worst.gap = std::max(worst.gap, std::abs(row.bound / row.weight - apart));
  }
  return worst;
}

TEST(SmoothNormals, AreExactOnCylindersAndSpheresWhateverTheFaces)
{
  const auto cylinder = [](double radius) {
    return [radius](double x, double y) { return Point(radius * std::sin(x), 2 * y, radius * std::cos(x)); };
  };
  const auto sphere = [](double radius) {
    return [radius](double x, double y) { return Point(radius * Point(std::tan(x), std::tan(y), 1).normalized()); };
  };
  for (const bool triangles : {true, false}) {
    const auto round = errors(
        cylinder(2), cylinder(2.01), [](const Point& x) { return Point(x[0] / 2, 0, x[2] / 2); }, 0.01, 7, triangles);
    EXPECT_LT(round.direction, 1e-4);               // means of the normals of faces: 0.03
    EXPECT_LT(round.gap, triangles ? 3e-4 : 2e-3);  // the facets alone are wrong by up to 0.02
    const auto ball = errors(
        sphere(2), sphere(2.01), [](const Point& x) { return Point(x / 2); }, 0.01, 7, triangles);
    EXPECT_LT(ball.direction, 1e-4);
    EXPECT_LT(ball.gap, triangles ? 3e-4 : 2e-3);
  }
}

// A side one cell long, as of a slice: nothing says how it curves along its axis, so it does not.
TEST(SmoothNormals, OfASideOneCellLongDoNotTiltAlongIt)
{
  const Communicator comm;
  const auto half = [](double radius) {
    return [radius](double x, double y) { return Point(radius * std::cos(x), radius * std::sin(x), y); };
  };
  for (const int n : {6, 8, 15})
    for (const double length : {0.05, 0.575, 3.0}) {
      const Grid grid{n, 1, 0, std::numbers::pi, 0, length, true};
      auto other = grid;
      other.up = false, other.first_id = primary_ids;
      const auto pair = make_pair(surface(grid, half(1), comm), surface(other, half(1.01), comm), Law::frictionless);
      const auto nodes = nodes_of(pair, comm);
      const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
      EXPECT_EQ(rows.rows.size(), static_cast<std::size_t>(2 * (n + 1)));
      for (const auto& row : rows.rows) {
        const auto& x = nodes.at(row.node);
        EXPECT_LT(std::abs(row.normal[2]), 1e-4) << n << " faces, length " << length << ", at " << x.transpose();
      }
    }
}

// Half the size, an eighth of the error.
TEST(SmoothNormals, AreOfThirdOrderOnOtherSurfaces)
{
  const auto sheet = [](double x, double y) { return Point(x, y, (x * x - 0.5 * x * y - y * y) / 10 + x * x * x / 30); };
  const auto above = [&](double x, double y) { return Point(x, y, sheet(x, y)[2] + 1e-7); };
  const auto normal = [](const Point& x) {
    return Point(-(2 * x[0] - 0.5 * x[1]) / 10 - x[0] * x[0] / 10, (0.5 * x[0] + 2 * x[1]) / 10, 1).normalized();
  };
  for (const bool triangles : {true, false}) {
    const auto coarse = errors(sheet, above, normal, 1e-7, 6, triangles),
               fine = errors(sheet, above, normal, 1e-7, 24, triangles);
    EXPECT_LT(coarse.direction, 5e-3);
    EXPECT_LT(fine.direction, coarse.direction / 10);
    EXPECT_LT(fine.gap, 2e-5);  // the facets alone: 2e-4
  }
}

// A ridge of 30 degrees is no kink, and nothing of second order goes along it: the planes beside it keep their normals.
TEST(SmoothNormals, OfPlanesBesideARidgeAreTheirOwn)
{
  const Communicator comm;
  const double slope = std::tan(0.2618);
  const auto roof = [&](double x, double y) { return Point(x, y, -slope * std::abs(x)); };
  const auto pair = make_pair(surface({6, 4, -3, 3, 0, 4, true, true}, roof, comm),
                              surface({6, 4, -3, 3, 0, 4, false, true, primary_ids}, roof, comm), Law::frictionless);
  const auto nodes = nodes_of(pair, comm);
  for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows) {
    const double x = nodes.at(row.node)[0], y = nodes.at(row.node)[1];
    if (y < 0.1 || y > 3.9) continue;  // at borders normals continue what curvature there seems to be
    const Point expected = Point(x > 0.1 ? slope : x < -0.1 ? -slope : 0, 0, 1).normalized();
    EXPECT_LT((row.normal - expected).norm(), std::abs(x) > 1.1 ? 1e-12 : 0.05) << x;
    EXPECT_NEAR(row.bound, 0, 1e-12);
  }
}

// A wedge in a groove of 120 degrees, 0.01 apart: in the edge of either, too, the gap is that of the faces, along their normals.
// A line from the groove's edge along the normal of one of its faces passes the wedge's edge and meets its other side.
TEST(SmoothNormals, InConcaveEdgesGapsAreThoseOfTheFaces)
{
  const Communicator comm;
  const double slope = std::tan(std::numbers::pi / 6), apart = 0.01;
  const auto groove = [&](double x, double y) { return Point(x, y, slope * std::abs(x)); };
  const auto wedge = [&](double x, double y) {
    return Point(x, y, slope * std::abs(x) + apart / std::cos(std::numbers::pi / 6));
  };
  for (const bool triangles : {false, true})
    for (const bool turned : {false, true}) {
      const auto lower = surface({6, 4, -1, 1, 0, 1, true, triangles, turned ? primary_ids : 0}, groove, comm),
                 upper = surface({8, 3, -1.1, 1.1, -0.1, 1.1, false, triangles, turned ? 0 : primary_ids}, wedge, comm);
      const auto pair = turned ? make_pair(upper, lower, Law::frictionless) : make_pair(lower, upper, Law::frictionless);
      const auto nodes = nodes_of(pair, comm);
      int in_edge = 0;
      for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows) {
        const Point x = nodes.at(row.node);
        if (std::abs(x[0]) < 1e-9) ++in_edge;
        EXPECT_NEAR(std::abs(row.normal[2]), std::cos(std::numbers::pi / 6), 1e-12) << x.transpose();
        EXPECT_NEAR(row.bound / row.weight, apart, 1e-12) << x.transpose();
      }
      EXPECT_GE(in_edge, 6);  // rows of both faces
    }
}

}  // namespace
}  // namespace mortise::contact
