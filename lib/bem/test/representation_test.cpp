#include "bem/representation.hpp"

#include <gtest/gtest.h>

#include <random>

#include "surfaces.hpp"

namespace mortise::bem {
namespace {

using namespace test;

const Eigen::Matrix3d some_gradient = (Eigen::Matrix3d() << 0.3, 0.2, -0.5, 0.7, -0.4, 0.1, 0.25, 0.9, 0.6).finished();

Eigen::VectorXd random_vector(Eigen::Index size, unsigned seed)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(generator); });
}

// Points of the surface and the inward directions that lead into the box from them: faces, edges and corners.
std::vector<std::pair<Point, Point>> places(const Point& size)
{
  std::vector<std::pair<Point, Point>> result;
  for (const double a : {0.0, 0.37, 1.0})
    for (const double b : {0.0, 0.52, 1.0})
      for (const double c : {0.0, 0.61, 1.0}) {
        const Point at(a, b, c);
        Point inward = Point::Zero();
        for (int k = 0; k < 3; ++k) inward[k] = at[k] == 0 ? 1 : at[k] == 1 ? -1 : 0;
        if (inward.norm() > 0) result.emplace_back(at.cwiseProduct(size), inward);
      }
  return result;
}

struct Errors {
  double displacement = 0, stress = 0;
};
Errors errors(const Panels& panels, const Field& field, const std::vector<Point>& points, double accuracy = 1e-5)
{
  const auto found = inside(panels, points, field.nodal(panels), field.tractions(panels, steel()), accuracy);
  Errors result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    result.displacement = std::max(result.displacement, (found.displacement.row(row).transpose() - field.u(points[i])).norm());
    const fem::Stress exact = components(hooke(steel(), field.gradient(points[i])));
    result.stress = std::max(result.stress, (found.stress.row(row).transpose() - exact).norm());
  }
  return result;
}

TEST(Representation, ConstantStressIsExactUpToFacesEdgesAndCorners)
{
  const Point size(2, 1, 1.5);
  const auto panels = box({3, 2, 4}, size, [](double s) { return s * s; });
  for (const double distance : {0.3, 1e-2, 1e-4, 1e-6, 1e-9, 0.0}) {
    std::vector<Point> points;
    for (const auto& [at, inward] : places(size)) points.push_back(at + distance * inward);
    const auto [displacement, stress] = errors(panels, linear(some_gradient), points);
    EXPECT_LT(displacement, 1e-13) << distance;
    EXPECT_LT(stress, 1e-12) << distance;
  }
}

TEST(Representation, LargeRotationsLeaveStressesAlone)
{
  const auto panels = box({3, 2, 4}, {2, 1, 1.5});
  const auto bent = bending(steel().poisson_ratio);
  Eigen::Matrix3d spin = Eigen::Matrix3d::Zero();
  spin(0, 1) = -1e4;
  spin(1, 0) = 1e4;
  const Eigen::VectorXd u = bent.nodal(panels), t = bent.tractions(panels, steel()),
                        turned = u + linear_field(panels, {1e4, 0, 0}, spin, {0, 0, 0});
  const std::vector<Point> points{{1, 0.5, 0.7}, {0.2, 0.1, 0.03}, {1.9, 0.5, 1.4999}};
  EXPECT_LT((inside(panels, points, u, t, 1e-4).stress - inside(panels, points, turned, t, 1e-4).stress).norm(), 1e-9);
}

// Somigliana's identity with its kernels U, T, D and S [Brebbia, Telles and Wrobel, Boundary element techniques, 1984,
// sections 5.2 and 5.10], of arbitrary u and t, on panels cut fine. The points are farther from the surface
// than a panel is large.
TEST(Representation, AgreesWithTheKernelsOfTextbooks)
{
  const auto panels = box({8, 4, 6}, {2, 1, 1.5});
  const auto material = steel();
  const double nu = material.poisson_ratio, mu = shear_modulus(material), pi = std::numbers::pi;
  const Eigen::VectorXd u = random_vector(3 * panels.node_count(), 1), t = random_vector(3 * panels.size(), 2);
  const std::vector<Point> points{{0.9, 0.4, 0.6}, {0.5, 0.7, 1.1}, {0.4, 0.3, 0.31}};
  // The midpoints of Gauss and Legendre's rule with 5 points on [0, 1].
  constexpr std::array<std::pair<double, double>, 5> gauss{{{0.046910077030668, 0.118463442528095},
                                                            {0.230765344947158, 0.239314335249683},
                                                            {0.5, 0.284444444444444},
                                                            {0.769234655052841, 0.239314335249683},
                                                            {0.953089922969332, 0.118463442528095}}};
  constexpr int parts = 4;
  const auto recovered = recovered_stresses(panels, material, {u, t});
  const auto found = Representation(panels, material, 1e-12).evaluate(points, u, t, recovered),
             usual = Representation(panels, material, 1e-5).evaluate(points, u, t, recovered);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point displacement = Point::Zero();
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    const auto add = [&](const Point& y, const Point& n, const Point& force, const Point& value, double weight) {
      const Point d = y - points[i];
      const double r = d.norm();
      const Point e = d / r;
      const double slope = e.dot(n);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const double same = a == b;
          displacement[a] += weight * ((3 - 4 * nu) * same + e[a] * e[b]) / (16 * pi * mu * (1 - nu) * r) * force[b];
          displacement[a] += weight *
                             (slope * ((1 - 2 * nu) * same + 3 * e[a] * e[b]) - (1 - 2 * nu) * (e[a] * n[b] - e[b] * n[a])) /
                             (8 * pi * (1 - nu) * r * r) * value[b];
          for (int k = 0; k < 3; ++k) {
            const double ka = k == a, kb = k == b;
            stress(a, b) += weight * ((1 - 2 * nu) * (ka * e[b] + kb * e[a] - same * e[k]) + 3 * e[a] * e[b] * e[k]) /
                            (8 * pi * (1 - nu) * r * r) * force[k];
            stress(a, b) -= weight * mu / (4 * pi * (1 - nu) * r * r * r) *
                            (3 * slope * ((1 - 2 * nu) * same * e[k] + nu * (ka * e[b] + kb * e[a]) - 5 * e[a] * e[b] * e[k]) +
                             3 * nu * (n[a] * e[b] * e[k] + n[b] * e[a] * e[k]) +
                             (1 - 2 * nu) * (3 * n[k] * e[a] * e[b] + n[b] * ka + n[a] * kb) - (1 - 4 * nu) * n[k] * same) *
                            value[k];
          }
        }
    };
    for (std::size_t p = 0; p < panels.corners.size(); ++p)
      for (int strip = 0; strip < parts; ++strip)
        for (int cell = 0; cell < parts; ++cell)
          for (const auto& [s0, ws] : gauss)
            for (const auto& [q0, wq] : gauss) {
              const double s = (strip + s0) / parts, q = (cell + q0) / parts;
              const std::array<double, 3> at{1 - s, s * (1 - q), s * q};
              Point y = Point::Zero(), value = Point::Zero();
              for (int k = 0; k < 3; ++k) {
                const double w = at[static_cast<std::size_t>(k)];
                y += w * panels.corner(p, k);
                value += w * u.segment<3>(3 * panels.corners[p][static_cast<std::size_t>(k)]);
              }
              add(y, panels.normal[p], t.segment<3>(3 * static_cast<Eigen::Index>(p)), value,
                  2 * panels.area[p] * s * ws * wq / (parts * parts));
            }
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_LT((found.displacement.row(row).transpose() - displacement).norm(), 1e-9 * displacement.norm()) << i;
    EXPECT_LT((found.stress.row(row).transpose() - components(stress)).norm(), 1e-8 * stress.norm()) << i;
    EXPECT_LT((usual.displacement - found.displacement).row(row).norm(), 1e-4 * displacement.norm()) << i;
    EXPECT_LT((usual.stress - found.stress).row(row).norm(), 1e-4 * stress.norm()) << i;
  }
}

// The error is the surface's: u linear and t constant on panels are of second order inside.
TEST(Representation, PointForceOutsideIsOfSecondOrderInside)
{
  const auto field = kelvin(steel(), {0.7, 0.4, 2.5}, {0.3, -0.5, 1});
  const std::vector<Point> points{{1, 0.5, 0.7}, {0.6, 0.3, 1.1}, {1.4, 0.6, 0.5}};
  const auto coarse = errors(box({8, 4, 6}, {2, 1, 1.5}), field, points),
             fine = errors(box({16, 8, 12}, {2, 1, 1.5}), field, points);
  EXPECT_LT(fine.displacement, coarse.displacement / 3.2);
  EXPECT_LT(fine.stress, coarse.stress / 3.2);
  EXPECT_LT(fine.displacement, 5e-3 * field.u(points[1]).norm());
  EXPECT_LT(fine.stress, 5e-3 * hooke(steel(), field.gradient(points[1])).norm());
}

// The recovery at the nodes is exact for a quadratic displacement; the error comes from the panels' own second order and is
// largest where both share in the stress.
TEST(Representation, BendingNextToTheSurface)
{
  const auto field = bending(steel().poisson_ratio);
  const Point size(2, 1, 1);
  const double largest = steel().young_modulus * size[2];
  const auto panels = box({16, 8, 8}, size);
  for (const double distance : {0.8, 0.5, 0.3, 0.1, 1e-3, 1e-6}) {
    std::vector<Point> points;
    for (const auto& [at, inward] : places(size)) points.push_back(at + distance / 8 * inward);
    const auto [displacement, stress] = errors(panels, field, points);
    EXPECT_LT(displacement, 2e-3) << distance;
    EXPECT_LT(stress, (distance < 1e-2 ? 1e-5 : 4e-3) * largest) << distance;
  }
}

// Lame's solution.
TEST(Representation, ThickSphereUnderInnerPressure)
{
  const double inner = 1, outer = 2, nu = steel().poisson_ratio, young = steel().young_modulus;
  const auto hollow = [&](int levels) {
    auto out = sphere(outer, levels), in = sphere(inner, levels);
    const auto shift = static_cast<Local>(out.points.size());
    out.points.insert(out.points.end(), in.points.begin(), in.points.end());
    for (const auto& [a, b, c] : in.corners) out.corners.push_back({a + shift, c + shift, b + shift});
    return make_panels(out.points, out.corners);
  };
  // sigma_r = a (1 - (outer / r)^3), u = (a (1 - 2 nu) r + a (1 + nu) outer^3 / (2 r^2)) / E, a = p inner^3 / (outer^3 - inner^3)
  const double a = std::pow(inner, 3) / (std::pow(outer, 3) - std::pow(inner, 3)), b = std::pow(outer, 3);
  const Field field{[=](const Point& x) -> Point {
                      const double r = x.norm();
                      return a / young * ((1 - 2 * nu) + (1 + nu) * b / (2 * r * r * r)) * x;
                    },
                    [=](const Point& x) -> Eigen::Matrix3d {
                      const double r = x.norm(), c = (1 + nu) * b / (2 * r * r * r);
                      return a / young * ((1 - 2 * nu + c) * Eigen::Matrix3d::Identity() - 3 * c / (r * r) * x * x.transpose());
                    }};
  // In the middle of the wall, where sigma_r = a (1 - (2 / 1.5)^3).
  const Point direction = Point(0.3, -0.5, 0.8).normalized();
  EXPECT_NEAR(direction.dot(hooke(steel(), field.gradient(1.5 * direction)) * direction), a * (1 - std::pow(outer / 1.5, 3)),
              1e-14);
  const std::vector<Point> points{1.5 * direction, {0, 1.4, 0}, {0, 1, -1.2}};
  const auto coarse = errors(hollow(2), field, points), fine = errors(hollow(3), field, points);
  EXPECT_LT(fine.displacement, coarse.displacement / 3);
  EXPECT_LT(fine.stress, coarse.stress / 3);
  EXPECT_LT(fine.stress, 0.02);
}

TEST(Location, InsideOrOutsideNearFacesEdgesAndCorners)
{
  const Point size(2, 1, 1.5);
  const auto panels = box({3, 2, 4}, size);
  const Representation surface(panels, steel());
  for (const auto& [at, inward] : places(size))
    for (const double distance : {0.2, 1e-3, 1e-6, 1e-9}) {
      const auto in = surface.locate(at + distance * inward), out = surface.locate(at - distance * inward);
      EXPECT_TRUE(in.inside) << at.transpose() << ", " << distance;
      EXPECT_FALSE(out.inside) << at.transpose() << ", " << distance;
      EXPECT_NEAR(in.distance, distance, 1e-14);
      EXPECT_NEAR(out.distance, distance * inward.norm(), 1e-14);
    }
  EXPECT_EQ(surface.locate({1, 0.5, 1.5}).distance, 0);
  EXPECT_FALSE(surface.locate({1e3, 1e3, 1e3}).inside);
}

TEST(Location, ManyPanels)
{
  const auto ball = sphere(1, 4);
  const Representation surface(ball, steel());
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Point x(uniform(generator), uniform(generator), uniform(generator));
    // The panels lie between the radii 0.995 and 1.
    if (std::abs(x.norm() - 0.9975) < 0.0025) continue;
    const auto found = surface.locate(x);
    EXPECT_EQ(found.inside, x.norm() < 1);
    EXPECT_NEAR(found.distance, std::abs(1 - x.norm()), 0.005);
    const Point middle = (ball.corner(found.panel, 0) + ball.corner(found.panel, 1) + ball.corner(found.panel, 2)) / 3;
    EXPECT_LT((middle.normalized() - x.normalized()).norm(), 0.12 + 0.1 * (x.norm() < 0.5) / x.norm());
  }
}

}  // namespace
}  // namespace mortise::bem
