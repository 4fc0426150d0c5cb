#include "../src/panel_potentials.hpp"

#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace mortise::bem {
namespace {

using namespace test;

struct Triangle {
  Point a, b, c;
  double area() const { return (b - a).cross(c - a).norm() / 2; }
  Point centre() const { return (a + b + c) / 3; }
};

// Cut into four until it is small for its distance from x, then by the rule of degree 5 [Radon 1948].
template <class Integrand>
void integrate(const Triangle& t, const Point& x, const Integrand& add)
{
  const Point m = t.centre();
  if (std::max({(t.a - m).norm(), (t.b - m).norm(), (t.c - m).norm()}) > 0.04 * (x - m).norm()) {
    const Point ab = (t.a + t.b) / 2, bc = (t.b + t.c) / 2, ca = (t.c + t.a) / 2;
    for (const auto& part : {Triangle{t.a, ab, ca}, {ab, t.b, bc}, {ca, bc, t.c}, {ab, bc, ca}}) integrate(part, x, add);
    return;
  }
  add(m, 0.225 * t.area());
  for (const double sign : {-1.0, 1.0}) {
    const double s = (6 + sign * std::sqrt(15.0)) / 21, weight = (155 + sign * std::sqrt(15.0)) / 1200 * t.area();
    for (const auto& [p, q, r] : {std::array{t.a, t.b, t.c}, {t.b, t.c, t.a}, {t.c, t.a, t.b}})
      add(s * (p + q) + (1 - 2 * s) * r, weight);
  }
}

// Over the middle of the panel, over and beside its edges and corners, on either side.
TEST(PanelPotentials, AgreeWithQuadrature)
{
  const auto panels = make_panels({{0.1, 0.2, 0.3}, {1.3, 0.1, 0.4}, {0.5, 1.1, -0.1}, {0.4, 0.6, 1.3}},
                                  {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  const Point c(0.3, -0.8, 0.5), n = panels.normal[1];
  const Triangle triangle{panels.corner(1, 0), panels.corner(1, 1), panels.corner(1, 2)};
  for (const auto& [s, q] :
       {std::pair{0.3, 0.3}, {0.4, 0.0}, {0.5, 0.5}, {0.0, 0.0}, {1.0, 0.0}, {-0.02, 0.3}, {1.4, 0.0}, {0.6, 0.9}})
    for (const double height : {0.7, 0.05, 1e-3, -1e-3, -0.2}) {
      const Point x = triangle.a + s * (triangle.b - triangle.a) + q * (triangle.c - triangle.a) + height * n;
      PanelPotentials sum{0, 0, Point::Zero(), Point::Zero(), Eigen::Matrix3d::Zero()};
      integrate(triangle, x, [&](const Point& y, double weight) {
        const Point d = x - y;
        const double r = d.norm(), g = weight / r, g3 = g / (r * r), along = d.dot(c);
        sum.single += g;
        sum.angle += g3 * n.dot(d);
        sum.attraction += g3 * d;
        sum.tensor += g3 * along * d;
        sum.triple += 3 * g3 / (r * r) * along * d * d.transpose();
      });
      const auto found = panel_potentials(panels, 1, x, c);
      EXPECT_NEAR(found.single, sum.single, 1e-8);
      EXPECT_NEAR(found.angle, sum.angle, 1e-7);
      EXPECT_NEAR(solid_angle(panels, 1, x), sum.angle, 1e-7);
      EXPECT_LT((found.attraction - sum.attraction).norm(), 1e-7);
      EXPECT_LT((found.tensor - sum.tensor).norm(), 1e-7);
      EXPECT_LT((found.triple - sum.triple).norm(), 1e-6) << s << ", " << q << ", " << height;
    }
}

// Solid angles of a closed surface: 4 pi inside, none outside. On a panel the plane is half the sky.
TEST(PanelPotentials, SolidAngles)
{
  const auto ball = sphere(1, 2);
  for (const auto& [x, expected] : {std::pair{Point(0.1, 0.2, -0.3), -4 * std::numbers::pi}, {Point(0.8, 0.7, 0), 0.0}}) {
    double sum = 0;
    for (std::size_t p = 0; p < ball.corners.size(); ++p) sum += solid_angle(ball, p, x);
    EXPECT_NEAR(sum, expected, 1e-12);
  }
  const Point middle = (ball.corner(5, 0) + ball.corner(5, 1) + ball.corner(5, 2)) / 3;
  EXPECT_NEAR(solid_angle(ball, 5, middle + 1e-9 * ball.normal[5]), 2 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(solid_angle(ball, 5, middle - 1e-9 * ball.normal[5]), -2 * std::numbers::pi, 1e-6);
}

// On the line of an edge itself the logarithms stay finite.
TEST(PanelPotentials, FiniteOnEdgesAndCorners)
{
  const auto panels = box({1, 1, 1}, {1, 1, 1});
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (int k = 0; k < 3; ++k) {
      const Point a = panels.corner(p, k), b = panels.corner(p, (k + 1) % 3);
      for (const double s : {0.0, 0.5, 1.0, 2.0}) {
        const auto found = panel_potentials(panels, p, a + s * (b - a), {1, 2, 3});
        EXPECT_LT(found.attraction.norm(), 100);
        EXPECT_LT(found.triple.norm(), 1000);
        EXPECT_NEAR(found.single, panel_potentials(panels, p, a + s * (b - a) + 1e-7 * panels.normal[p], {1, 2, 3}).single, 1e-5);
      }
    }
}

}  // namespace
}  // namespace mortise::bem
