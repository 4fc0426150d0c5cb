// What the smooth surface stands out of a facet.
#include "surface/bulge.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace mortise::contact {
namespace {

// Corners between which a cylinder turns by half a face and a whole one, as those of the facet in the middle of an eight-node
// face; others lie anyhow.
TEST(Bulge, IsExactOnCylindersHoweverFacetsLie)
{
  constexpr double radius = 10, turn = 0.2;
  const auto normal = [](double angle) { return Point(std::cos(angle), std::sin(angle), 0); };
  const auto corner = [&](double angle, double z) { return Point(radius * normal(angle) + z * Point::UnitZ()); };
  using Places = std::vector<std::pair<double, double>>;
  for (const auto& places :
       {Places{{0, 0}, {turn, 1}, {0, 2}, {-turn, 1}}, Places{{0, 0}, {turn, 0.3}, {0.7 * turn, 2}, {-0.4 * turn, 1.5}},
        Places{{0, 0}, {turn, 0}, {turn, 1}, {0, 1}}}) {
    FaceGeometry facet{mesh::CellType::quad4, {}};
    std::vector<Point> normals;
    for (const auto& [angle, z] : places) {
      facet.nodes.push_back(corner(angle, z));
      normals.push_back(normal(angle));
    }
    const Bulge bulge(facet, normals, true);
    for (const double a : {0.5, 0.1, 0.9})
      for (const double b : {0.5, 0.7}) {
        const Eigen::Vector4d shape((1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b);
        Point at = Point::Zero();
        for (std::size_t k = 0; k < 4; ++k) at += shape[static_cast<Eigen::Index>(k)] * facet.nodes[k];
        EXPECT_NEAR(bulge(shape), radius - at.head<2>().norm(), 1e-13) << a << " " << b;
        for (const double tilt : {0.0, 0.1, -0.2}) {  // |at + distance line| = radius in the plane across the axis
          const Point line = Eigen::AngleAxisd(tilt, Point::UnitZ()) * Point(at[0], at[1], 0).normalized();
          const double half = at.dot(line),
                       distance = std::sqrt(half * half + radius * radius - at.head<2>().squaredNorm()) - half;
          EXPECT_NEAR(bulge.along(-line, shape), distance, 1e-3 * distance) << a << " " << b;
        }
      }
  }
}

// On a torus and a cone, whose curvatures change over a facet, with a hundredth of what the facets are wrong by.
TEST(Bulge, IsOfThirdOrderWhereCurvaturesChange)
{
  struct Surface {
    std::function<Point(double, double)> at, normal;
    std::function<double(const Point&)> under;
  };
  const auto along = [](double a) { return Point(std::cos(a), std::sin(a), 0); };
  const Surface torus{
      [&](double a, double c) { return Point((10 + 3 * std::cos(c)) * along(a) + 3 * std::sin(c) * Point::UnitZ()); },
      [&](double a, double c) { return Point(std::cos(c) * along(a) + std::sin(c) * Point::UnitZ()); },
      [](const Point& x) { return 3 - std::hypot(x.head<2>().norm() - 10, x[2]); }};
  const double slant = std::sqrt(1.25);
  const Surface cone{[&](double a, double z) { return Point((10 + z / 2) * along(a) + z * Point::UnitZ()); },
                     [&](double a, double) { return Point((along(a) - Point::UnitZ() / 2) / slant); },
                     [&](const Point& x) { return (10 + x[2] / 2 - x.head<2>().norm()) / slant; }};
  const auto errors = [](const Surface& surface, double a, double c, const std::vector<std::pair<double, double>>& places) {
    FaceGeometry facet{places.size() == 4 ? mesh::CellType::quad4 : mesh::CellType::tri3, {}};
    std::vector<Point> normals;
    for (const auto& [x, y] : places) {
      facet.nodes.push_back(surface.at(a * x, 1 + c * y));
      normals.push_back(surface.normal(a * x, 1 + c * y));
    }
    const Bulge bulge(facet, normals, true);
    double error = 0, sagitta = 0;
    for (double u = 0.1; u < 1; u += 0.2)
      for (double v = 0.1; v < (places.size() == 4 ? 1 : 0.95 - u); v += 0.2) {
        const Eigen::Vector4d shape = places.size() == 4 ? Eigen::Vector4d((1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v)
                                                         : Eigen::Vector4d(1 - u - v, u, v, 0);
        Point x = Point::Zero();
        for (std::size_t k = 0; k < places.size(); ++k) x += shape[static_cast<Eigen::Index>(k)] * facet.nodes[k];
        error = std::max(error, std::abs(bulge(shape) - surface.under(x)));
        sagitta = std::max(sagitta, surface.under(x));
      }
    return std::pair(error, sagitta);
  };
  for (const auto& places : {std::vector<std::pair<double, double>>{{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                             {{0, -0.5}, {0.5, 0}, {0, 0.5}, {-0.5, 0}},
                             {{0, 0}, {1, 0.1}, {0.8, 1.1}, {-0.2, 0.8}},
                             {{0, 0}, {1, 0}, {1, 1}},
                             {{0, 0}, {1, 0}, {0.3, 1}}}) {
    const auto [torus_error, torus_sagitta] = errors(torus, 0.15, 0.25, places);
    EXPECT_LT(torus_error, 0.012 * torus_sagitta) << places.size();
    EXPECT_LT(8 * errors(torus, 0.075, 0.125, places).first, 1.1 * torus_error) << places.size();
    const auto [cone_error, cone_sagitta] = errors(cone, 0.25, 2, places);
    EXPECT_LT(cone_error, 0.012 * cone_sagitta) << places.size();
  }
}

}  // namespace
}  // namespace mortise::contact
