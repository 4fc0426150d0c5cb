#include "integrals/quadrature.hpp"

#include <gtest/gtest.h>

#include "integrals/overlap.hpp"
#include "integrals/shape.hpp"

namespace mortise::contact {
namespace {

// A trapezium of height 2 whose sides are 1 -+ variation times 2 long; its Jacobian varies by that along its height.
Few<Plane, 4> trapezium(double variation)
{
  const double low = 1 + variation, high = 1 - variation;
  return {Plane(-low, -1), Plane(low, -1), Plane(high, 1), Plane(-high, 1)};
}

// Products of two of the four bilinear functions, or of two squares of them, which have the degrees of second order.
Eigen::Matrix4d products(const Polygon& polygon, const Few<Plane, 4>& nodes, Integrand integrand)
{
  const Locator locator(mesh::CellType::quad4, nodes);
  std::vector<Sample> points;
  sample(polygon, integrand, points);
  Eigen::Matrix4d result = Eigen::Matrix4d::Zero();
  for (const auto& point : points) {
    Eigen::Vector4d phi = locator(point.at);
    if (integrand.second_order) phi = phi.cwiseAbs2().eval();
    result += point.weight * phi * phi.transpose();
  }
  return result;
}

// The whole and its quarters, on which the same rule is far more exact.
TEST(Quadrature, ProductsOnTrapeziaAreExactTo1e10)
{
  for (const bool second_order : {false, true})
    for (const double variation : {0.0, 0.01, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4}) {
      const auto nodes = trapezium(variation);
      const Polygon whole{nodes[0], nodes[1], nodes[2], nodes[3]};
      Plane middle = Plane::Zero();
      for (const auto& x : nodes) middle += x / 4;
      Eigen::Matrix4d fine = Eigen::Matrix4d::Zero();
      for (std::size_t i = 0; i < 4; ++i) {
        const Plane before = (nodes[(i + 3) % 4] + nodes[i]) / 2, after = (nodes[i] + nodes[(i + 1) % 4]) / 2;
        fine += products({before, nodes[i], after, middle}, nodes, {second_order, variation > 0 ? 0.4 : 0});
      }
      const auto coarse = products(whole, nodes, {second_order, variation});
      EXPECT_LT((coarse - fine).norm(), 1e-10 * fine.norm()) << second_order << ' ' << variation;
    }
}

TEST(Quadrature, PointsGrowWithTheVariationOfTheJacobian)
{
  const auto nodes = trapezium(0);
  const Polygon square{nodes[0], nodes[1], nodes[2], nodes[3]};
  std::size_t before = 0;
  for (const double variation : {0.0, 0.01, 0.15, 0.25, 0.5}) {
    std::vector<Sample> points;
    sample(square, {true, variation}, points);
    EXPECT_GT(points.size(), before) << variation;
    before = points.size();
  }
}

}  // namespace
}  // namespace mortise::contact
