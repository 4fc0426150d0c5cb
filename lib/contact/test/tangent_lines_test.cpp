// Normals in the lines where a plane, straight lines or an arc run into an arc.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

struct Laid {
  Point x, normal;
  double bound;
};

// The rows of two sides at the same places, of (x, y) from (-4, 0) to (4, `along`), with faces of 1 x 1. Collective.
template <class Places>
std::vector<Laid> laid_on_itself(const Places& places, int along, bool triangles = false, bool second = false)
{
  const Communicator comm;
  const auto side = [&](bool up, Global first_id) {
    const auto corners = surface({8, along, -4, 4, 0, static_cast<double>(along), up, triangles, first_id}, places, comm);
    const auto type = triangles ? mesh::CellType::tri6 : mesh::CellType::quad8;
    return second ? second_order(corners, type, Eigen::Matrix3d::Identity(), first_id) : corners;
  };
  const auto pair = make_pair(side(true, 0), side(false, primary_ids), Law::frictionless);
  const auto nodes = nodes_of(pair, comm);
  std::vector<Laid> result;
  for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows)
    result.push_back({nodes.at(row.node), row.normal, row.bound});
  return result;
}

// A plane that runs into an arc of radius 2, faces of the plane four times as long as those of the arc, of 6 degrees: in the tangent
// line the normal is the plane's, and what is laid on it does not overlap.
TEST(NormalsInTangentLines, WhereAPlaneRunsIntoAnArcAreThoseOfThePlane)
{
  const auto runs = [](double x, double y) {
    return x < 0 ? Point(0.8 * x, y, 0) : Point(2 * std::sin(0.1 * x), y, 2 * (std::cos(0.1 * x) - 1));
  };
  for (const bool triangles : {false, true})
    for (const bool second : {false, true}) {
      int in_line = 0;
      for (const auto& [x, normal, bound] : laid_on_itself(runs, 4, triangles, second)) {
        if (std::abs(x[0]) > 1e-9) continue;
        ++in_line;
        EXPECT_LT((normal - Point::UnitZ()).norm(), 1e-12) << "at " << x.transpose();  // one surface over both: 0.04
        EXPECT_NEAR(bound, 0, 1e-12);
      }
      EXPECT_GE(in_line, 5);
    }
}

// The same where the plane is a single row of faces, between two arcs.
TEST(NormalsInTangentLines, OfAPlaneOfOneRowBetweenArcsAreItsOwn)
{
  const Communicator comm;
  const auto flat = [](double x, double y) {
    const double beyond = std::max(std::abs(x) - 1, 0.0), angle = 0.1 * beyond;
    return Point(std::copysign(std::min(std::abs(x), 1.0) + 2 * std::sin(angle), x), y, 2 * (std::cos(angle) - 1));
  };
  // Two rows of the primary side, one of the secondary: x from -5 to 5 with a face from -1 to 1.
  const auto single = [&](double x, double y) { return flat(x < -0.5 ? x - 0.5 : x > 0.5 ? x + 0.5 : 2 * x, y); };
  const auto pair = make_pair(surface({9, 4, -4.5, 4.5, 0, 4, true}, single, comm),
                              surface({10, 4, -5, 5, 0, 4, false, false, primary_ids}, flat, comm), Law::frictionless);
  const auto nodes = nodes_of(pair, comm);
  int in_line = 0;
  for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows) {
    if (std::abs(std::abs(nodes.at(row.node)[0]) - 1) > 1e-9) continue;
    ++in_line;
    EXPECT_LT((row.normal - Point::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(row.bound, 0, 1e-12);
  }
  EXPECT_GE(in_line, 10);
}

// A cylinder, or a cone, that runs into an arc: faces of its straight lines are no plane, and yet normals are normal to the lines.
TEST(NormalsInTangentLines, WhereStraightLinesRunIntoAnArcAreNormalToThem)
{
  for (const double slope : {0.0, 0.2})
    for (const bool triangles : {false, true})
      for (const bool second : {false, true}) {
        const double along = 1 / std::hypot(1, slope), across = slope * along;  // of the straight lines
        const auto runs = [&](double x, double y) {
          const double s = x < 0 ? 0.8 * x : 2 * std::sin(0.1 * x), t = x < 0 ? 0 : 2 * (std::cos(0.1 * x) - 1);
          const double radius = 5 + s * across + t * along, angle = 0.15 * y;
          return Point(s * along - t * across, radius * std::sin(angle), radius * std::cos(angle));
        };
        int in_line = 0;
        for (const auto& [x, normal, bound] : laid_on_itself(runs, 4, triangles, second)) {
          if (std::abs(x[0]) > 1e-9) continue;
          ++in_line;
          const double angle = std::atan2(x[1], x[2]);
          const Point line(along, across * std::sin(angle), across * std::cos(angle));
          // Middle nodes lie on chords, whose lines are less steep.
          EXPECT_NEAR(normal.dot(line), 0, second ? 1e-3 : 1e-9) << "at " << x.transpose();
        }
        EXPECT_GE(in_line, 5);
      }
}

// Where a curve begins to bend the other way two faces are in a plane, and are none.
TEST(NormalsInTangentLines, WhereAnArcBendsBackAreThoseOfTheArcs)
{
  constexpr double turn = 0.26, radius = 1 / turn, half = 2 * turn;  // two faces an arc
  const auto bends = [](double x, double y) {
    const double away = std::abs(x), t = std::max(2 - away, 0.0) * turn;
    const Point end(radius * std::sin(half) + std::max(away - 2, 0.0), 0, radius * (1 - std::cos(half)));
    return Point(std::copysign(end[0] - radius * std::sin(t), x), y, std::copysign(end[2] - radius * (1 - std::cos(t)), x));
  };
  int on_arcs = 0;
  for (const auto& [x, normal, bound] : laid_on_itself(bends, 4)) {
    const double away = std::abs(x[0]), end = radius * std::sin(half);
    if (away > end + 1e-9 || away < 1e-9) continue;  // in the middle the nodes round it lie in a plane
    ++on_arcs;
    const double slope = std::asin((end - away) / radius);
    EXPECT_LT((normal - Point(-std::sin(slope), 0, std::cos(slope))).norm(), 0.01) << "at " << x.transpose();
  }
  EXPECT_EQ(on_arcs, 20);
}

// Triangles that lie anyhow, where a cylinder or a wide arc runs into a narrow one: two surfaces of one tangent plane.
TEST(NormalsInTangentLines, WhereTwoArcsMeetAreThoseOfBoth)
{
  for (const double bend : {0.0, 0.1, -0.3}) {  // of the first one, along the axis, over that of the second
    const auto runs = [&](double x, double y) {
      const auto arc = [](double length, double curvature) {
        return curvature == 0 ? std::pair(length, 0.0)
                              : std::pair(std::sin(curvature * length) / curvature, (std::cos(curvature * length) - 1) / curvature);
      };
      const auto [along, off] = x < 0 ? arc(0.8 * x, bend / 2) : arc(0.4 * x, 0.5);
      const double radius = 5 + off, angle = 0.15 * (y + 0.4 * std::sin(2.5 * x));
      return Point(along, radius * std::sin(angle), radius * std::cos(angle));
    };
    int in_line = 0;
    for (const auto& [x, normal, bound] : laid_on_itself(runs, 6, true)) {
      if (std::abs(x[0]) > 1e-9 || x[1] < 1e-9) continue;  // at that border too few nodes lie round it to tell
      ++in_line;
      EXPECT_LT(std::abs(normal[0]), 3e-3) << bend << " at " << x.transpose();  // of one surface: 0.04
    }
    EXPECT_EQ(in_line, 6);
  }
}

}  // namespace
}  // namespace mortise::contact
