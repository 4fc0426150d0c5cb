// Directions and gaps of curved sides do not depend on how they are cut into faces.
#include <gtest/gtest.h>

#include <algorithm>
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

TEST(SmoothNormals, OnConesFollowThem)
{
  const auto cone = [](double radius) {
    return [radius](double x, double y) { return Point((radius + y) * std::sin(x), 2 * y, (radius + y) * std::cos(x)); };
  };
  const auto normal = [](const Point& x) {
    const Point along = Point(x[0], 0, x[2]).normalized();
    return Point((along - Point::UnitY() / 2) / std::sqrt(1.25));
  };
  for (const bool triangles : {true, false}) {
    const auto errors_of = errors(cone(4), cone(4.01), normal, 0.01 / std::sqrt(1.25), 7, triangles);
    EXPECT_LT(errors_of.direction, 2.2e-3);  // at borders; surfaces of second order through the nodes: 0.006
    EXPECT_LT(errors_of.gap, 3e-4);
  }
}

// A plane tells the direction of what is curved, with nothing of the curved side's own normal: bodies between parallel planes
// that are free along them would be driven by it.
TEST(SmoothNormals, OfACurvedSideOnAPlaneAreThePlanes)
{
  const Communicator comm;
  auto pair = make_pair(surface(
                            {6, 6, -0.7, 0.7, -0.7, 0.7, true, false, 0, 0.25},
                            [](double x, double y) { return Point(x, y, -0.1 * (x * x + y * y)); }, comm),
                        surface(
                            {4, 5, -0.9, 0.9, -0.9, 0.9, false, false, primary_ids, 0.25},
                            [](double x, double y) { return Point(x, y, 0.01); }, comm),
                        Law::frictionless);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  EXPECT_GE(rows.rows.size(), 20u);
  for (const auto& row : rows.rows) EXPECT_LT((row.normal - Point(0, 0, 1)).norm(), 1e-15);
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

// Two rows of nodes do not tell how a curvature changes: along an ellipse one cell wide normals are those of second order.
TEST(SmoothNormals, OfAStripOneCellWideAreNotOfThirdOrder)
{
  const Communicator comm;
  const auto ellipse = [](double apart) {
    return [apart](double x, double y) { return Point((10 + apart) * std::cos(x), (7 + apart) * std::sin(x), y); };
  };
  for (const bool triangles : {true, false}) {
    const Grid grid{8, 1, 0, std::numbers::pi / 2, 0, 5, true, triangles};
    const Grid other{11, 1, 0, std::numbers::pi / 2, 0, 5, false, triangles, primary_ids};
    const auto pair = make_pair(surface(grid, ellipse(0), comm), surface(other, ellipse(0.01), comm), Law::frictionless);
    const auto nodes = nodes_of(pair, comm);
    const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
    EXPECT_EQ(rows.rows.size(), 18U);
    for (const auto& row : rows.rows) {
      const Point& x = nodes.at(row.node);
      EXPECT_LT((row.normal - Point(x[0] / 100, x[1] / 49, 0).normalized()).norm(), 0.12) << x.transpose();
      EXPECT_NEAR(row.bound / row.weight, 0.01, 6e-4) << x.transpose();
    }
  }
}

// As where faces with a node that a support holds are not part of the boundary: tips have corners of the border alone round them.
TEST(SmoothNormals, AtABorderOfTeethAreExact)
{
  const Communicator comm;
  const auto cylinder = [](double radius) {
    return [radius](double x, double y) { return Point(radius * std::sin(x), y, radius * std::cos(x)); };
  };
  Grid teeth{9, 4, -0.7, 0.7, -1, 1, true, true};
  teeth.teeth = true;
  const Grid other{11, 5, -0.9, 0.9, -1.2, 1.2, false, true, primary_ids};
  const auto pair = make_pair(surface(teeth, cylinder(2), comm), surface(other, cylinder(2.01), comm), Law::frictionless);
  const auto nodes = nodes_of(pair, comm);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  double last = 0;
  for (const auto& row : rows.rows) {
    const Point& x = nodes.at(row.node);
    last = std::max(last, x[0]);
    EXPECT_LT((row.normal - Point(x[0] / 2, 0, x[2] / 2)).norm(), 1e-4) << "at " << x.transpose();
  }
  EXPECT_DOUBLE_EQ(last, 2 * std::sin(0.7));  // the tips have rows
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

// Ridges and grooves, also of a few degrees: the planes beside them keep their normals, up to the edge.
TEST(SmoothNormals, OfPlanesBesideARidgeAreTheirOwn)
{
  const Communicator comm;
  for (const bool triangles : {false, true})
    for (const double slope : {-0.3, -0.1, 0.02, 0.1, 0.27, 0.6}) {
      const auto roof = [&](double x, double y) { return Point(x, y, -slope * std::abs(x)); };
      const auto pair = make_pair(surface({6, 4, -3, 3, 0, 4, true, triangles}, roof, comm),
                                  surface({6, 4, -3, 3, 0, 4, false, triangles, primary_ids}, roof, comm), Law::frictionless);
      const auto nodes = nodes_of(pair, comm);
      for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows) {
        const double x = nodes.at(row.node)[0];
        const Point right = Point(slope, 0, 1).normalized(), left = Point(-slope, 0, 1).normalized();
        const double to_right = (row.normal - right).norm(), to_left = (row.normal - left).norm();
        EXPECT_LT(x > 0.1 ? to_right : x < -0.1 ? to_left : std::min(to_left, to_right), 1e-10) << slope << ", at " << x;
        EXPECT_NEAR(row.bound, 0, 1e-12);
      }
    }
}

// Two arcs of radius 30 that meet at an angle: the faces themselves turn by 2 degrees.
TEST(SmoothNormals, OfArcsBesideARidgeAreTheirOwn)
{
  const Communicator comm;
  constexpr double radius = 30;
  for (const bool triangles : {false, true})
    for (const double slope : {-0.3, -0.2, 0.2, 0.3}) {
      const double away = radius * slope / std::hypot(slope, 1);  // of the arcs' axes
      const auto arcs = [&](double x, double y) {
        return Point(
            x, y,
            std::sqrt(radius * radius - (std::abs(x) + away) * (std::abs(x) + away)) - std::sqrt(radius * radius - away * away));
      };
      const auto pair = make_pair(surface({6, 4, -3, 3, 0, 4, true, triangles}, arcs, comm),
                                  surface({6, 4, -3, 3, 0, 4, false, triangles, primary_ids}, arcs, comm), Law::frictionless);
      const auto nodes = nodes_of(pair, comm);
      for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows) {
        const Point& x = nodes.at(row.node);
        const auto off = [&](double way) {
          return (row.normal - Point(x[0] + way * away, 0, x[2] + std::sqrt(radius * radius - away * away)) / radius).norm();
        };
        EXPECT_LT(x[0] > 0.1 ? off(1) : x[0] < -0.1 ? off(-1) : std::min(off(-1), off(1)), 0.01) << slope << ", at " << x[0];
      }
    }
}

// The mitre of two fillets: its angle grows from nothing, and where the kink begins it has no border.
TEST(SmoothNormals, WhereAKinkBeginsLieBetweenThoseOfItsFaces)
{
  const Communicator comm;
  const auto fillet = [](double x) { return x > 0 ? 2 - std::sqrt(4 - x * x) : 0.0; };
  for (const bool triangles : {false, true})
    for (const int n : {8, 10, 12}) {
      const auto mitre = [&](double x, double y) { return Point(x, y, -std::max(fillet(x), fillet(y))); };
      const Grid lower{n, n, -1.6, 1.6, -1.6, 1.6, true, triangles},
          upper{n, n, -1.6, 1.6, -1.6, 1.6, false, triangles, primary_ids};
      const auto pair = make_pair(surface(lower, mitre, comm), surface(upper, mitre, comm), Law::frictionless);
      const auto nodes = nodes_of(pair, comm);
      for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows) {
        const Point& x = nodes.at(row.node);
        const double steep = std::max({x[0], x[1], 0.0}) / 2 + 0.22;  // sine of the slope, and of a face's turn
        EXPECT_GT(row.normal[2], std::sqrt(1 - std::min(steep * steep, 0.99))) << n << " faces, at " << x.transpose();
        EXPECT_GT(std::min(row.normal[0], row.normal[1]), -0.12) << n << " faces, at " << x.transpose();
      }
    }
}

// Six faces a wave turn most at the crests, and yet there is no kink; nor is there between straight faces of second order.
TEST(SmoothNormals, OfCoarseWavesAndStraightFacesHaveNoKinks)
{
  const Communicator comm;
  const auto wave = [](double x, double y) { return Point(x, y, 0.3 * std::cos(x * std::numbers::pi / 3)); };
  for (const bool triangles : {false, true}) {
    const auto pair = make_pair(surface({12, 4, -6, 6, 0, 4, true, triangles}, wave, comm),
                                surface({12, 4, -6, 6, 0, 4, false, triangles, primary_ids}, wave, comm), Law::frictionless);
    const auto nodes = nodes_of(pair, comm);
    for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows)
      if (const double x = nodes.at(row.node)[0]; std::abs(x) < 0.1 || std::abs(std::abs(x) - 3) < 0.1) {
        EXPECT_LT(std::abs(row.normal[0]), 1e-3) << "at " << x;  // a kink's: 0.15
      }
  }
  const auto arc = [](double x, double y) { return Point(4 * std::sin(x), y, 4 * std::cos(x)); };
  for (const auto type : {mesh::CellType::quad8, mesh::CellType::quad9, mesh::CellType::tri6}) {
    const bool triangles = type == mesh::CellType::tri6;
    const auto side = [&](bool up, Global first_id) {
      return second_order(surface({7, 4, -0.7, 0.7, 0, 3, up, triangles, first_id}, arc, comm), type, Eigen::Matrix3d::Identity(),
                          first_id);
    };
    const auto pair = make_pair(side(true, 0), side(false, primary_ids), Law::frictionless);
    const auto nodes = nodes_of(pair, comm);
    for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows) {
      const Point& x = nodes.at(row.node);
      const bool inside = std::abs(x[0]) < 2 && x[1] > 0.1 && x[1] < 2.9;
      if (inside && std::abs(std::hypot(x[0], x[2]) - 4) < 1e-9) {
        EXPECT_LT((row.normal - Point(x[0], 0, x[2]) / 4).norm(), 0.01) << "at " << x.transpose();
      }
    }
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
