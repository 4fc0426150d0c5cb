// The direct solution against closed forms: a string on an obstacle, a cylinder with friction, a belt on a drum.
#include <gtest/gtest.h>

#include <numbers>

#include "dense_programme.hpp"

namespace mortise::qp {
namespace {

// A string of length 2 and tension 1 under the load q, a depth below it an obstacle: up to sqrt(2 depth / q) from
// its ends it hangs free, and the obstacle bears the load of what lies on it.
TEST(CondensedNewton, AStringOnAnObstacle)
{
  constexpr int n = 199;
  constexpr double h = 2.0 / (n + 1), q = 3, depth = 0.4;
  MatrixProgramme p;
  p.a.resize(n, n);
  p.b.resize(n);
  std::vector<Bound> bounds;
  for (int i = 0; i < n; ++i) {
    const double x = h * (i + 1);
    for (int j = 0; j < n; ++j) p.a(i, j) = std::min(x, h * (j + 1)) * (2 - std::max(x, h * (j + 1))) / 2;
    p.b[i] = q * x * (2 - x) / 2 - depth;
    bounds.push_back({i});
  }
  p.g = MatrixXd(0, n);
  p.e = VectorXd(0);
  p.set = FeasibleSet(bounds, {});
  const auto point = p.solve();
  ASSERT_TRUE(point.converged);
  EXPECT_LT(violation(p, point), 1e-9);
  const double free = std::sqrt(2 * depth / q);
  for (int i = 0; i < n; ++i) {
    const double edge = std::min(h * (i + 1), 2 - h * (i + 1)) - free;
    EXPECT_NEAR(point.x[i], edge > 0 ? q * h : 0, (std::abs(edge) > h ? 1e-9 : 1.0) * q * h) << i;
  }
  EXPECT_NEAR(point.x.sum(), q * (2 - 2 * free), 0.01 * q);
}

// A cylinder on a half-plane in strips of constant pressure, pressed and pushed sideways: Hertz' half width and, of what sticks,
// that of Cattaneo and Mindlin, c = a sqrt(1 - Q / (mu P)). The half-plane gives way by -2 ln|x| / (pi E).
TEST(CondensedNewton, ACylinderOnAHalfPlane)
{
  constexpr int n = 200;
  constexpr double width = 0.5, h = width / n, e = 10, radius = 1, force = 0.2, coefficient = 0.4,
                   push = 0.6 * coefficient * force;
  const auto integral = [](double x) { return x == 0 ? 0 : x * std::log(std::abs(x)) - x; };
  MatrixProgramme p;
  p.a = MatrixXd::Zero(2 * n, 2 * n);
  p.b = VectorXd::Zero(2 * n);
  p.g = MatrixXd::Zero(2, 2 * n);
  std::vector<Bound> bounds;
  std::vector<Disc> discs;
  for (int i = 0; i < n; ++i) {
    const double x = h * (i + 0.5) - width / 2;
    for (int j = 0; j < n; ++j) {
      const double d = h * (i - j);
      p.a(2 * i, 2 * j) = p.a(2 * i + 1, 2 * j + 1) =
          -2 / (std::numbers::pi * e * h) * (integral(d + h / 2) - integral(d - h / 2));
    }
    p.b[2 * i] = -x * x / (2 * radius);
    p.g(0, 2 * i) = p.g(1, 2 * i + 1) = 1;
    bounds.push_back({2 * i});
    discs.push_back({{2 * i + 1, -1}});
    discs.back().normal = 2 * i;
    discs.back().coefficient = coefficient;
  }
  p.e = Vector2d(force, push);
  p.set = FeasibleSet(bounds, discs);
  const auto point = p.solve();
  ASSERT_TRUE(point.converged);
  EXPECT_LT(violation(p, point), 1e-9);
  const double a = std::sqrt(4 * force * radius / (std::numbers::pi * e)), c = a * std::sqrt(1 - push / (coefficient * force));
  ASSERT_LT(a, 0.45 * width);
  int closed = 0, sticks = 0;
  for (int i = 0; i < n; ++i) {
    const double x = h * (i + 0.5) - width / 2, normal = point.x[2 * i] / h, tangential = point.x[2 * i + 1] / h;
    closed += normal > 0;
    sticks += normal > 0 && std::abs(tangential) < (1 - 1e-9) * coefficient * normal;
    const double peak = e / (2 * radius) * a;
    const auto ellipse = [&](double half) { return e / (2 * radius) * std::sqrt(std::max(half * half - x * x, 0.0)); };
    EXPECT_NEAR(normal, ellipse(a), std::abs(std::abs(x) - a) > 3 * h ? 0.01 * peak : 0.2 * peak);
    EXPECT_NEAR(tangential / coefficient, ellipse(a) - ellipse(c),
                std::min(std::abs(std::abs(x) - a), std::abs(std::abs(x) - c)) > 3 * h ? 0.01 * peak : 0.2 * peak);
  }
  EXPECT_NEAR(closed * h, 2 * a, 3 * h);
  EXPECT_NEAR(sticks * h, 2 * c, 3 * h);
}

// A belt of n bars around a drum, drawn over it at one end by `drawn`, with a given force on the other: Eytelwein. Its bars'
// forces are unknowns without a constraint; what balances them at the nodes are rows of G.
MatrixProgramme belt(int n, double angle, double coefficient, double drawn, double compliance)
{
  const double part = angle / n, slack = 1;
  const Index size = n + 1 + 2 * n;  // forces of n + 1 bars; normal and tangential force at the n nodes between them
  MatrixProgramme p;
  p.a = MatrixXd::Zero(size, size);
  p.b = VectorXd::Zero(size);
  p.g = MatrixXd::Zero(2 * n + 1, size);
  p.e = VectorXd::Zero(2 * n + 1);
  std::vector<Bound> bounds;
  std::vector<Disc> discs;
  for (Index j = 0; j <= n; ++j) p.a(j, j) = part;
  p.b[0] = drawn;
  for (int i = 0; i < n; ++i) {
    const Local at = n + 1 + 2 * i;
    p.a(at, at) = p.a(at + 1, at + 1) = compliance * part;
    p.g(2 * i, at) = p.g(2 * i + 1, at + 1) = -1;
    p.g(2 * i, i) = p.g(2 * i, i + 1) = std::sin(part / 2);
    p.g(2 * i + 1, i) = std::cos(part / 2);
    p.g(2 * i + 1, i + 1) = -std::cos(part / 2);
    bounds.push_back({at});
    discs.push_back({{at + 1, -1}});
    discs.back().normal = at;
    discs.back().coefficient = coefficient;
  }
  p.g(2 * n, n) = 1;
  p.e[2 * n] = slack;
  p.set = FeasibleSet(bounds, discs);
  return p;
}

TEST(CondensedNewton, ABeltOnADrum)
{
  for (const double compliance : {1e-4, 1e-2, 1.0})  // of a point of the drum over that of a bar
    for (const double angle : {1.0, 3.0, 6.0})
      for (const double coefficient : {0.1, 0.5, 1.0}) {
        constexpr int n = 100;
        const double taut = std::exp(coefficient * angle), half = coefficient * std::tan(angle / n / 2);
        const auto p = belt(n, angle, coefficient, 10 * taut * angle, compliance);
        const auto point = p.solve();
        EXPECT_TRUE(point.converged) << "angle " << angle << ", coefficient " << coefficient << ", compliance " << compliance;
        EXPECT_LT(violation(p, point), 1e-9);
        EXPECT_NEAR(point.x[0] / std::pow((1 + half) / (1 - half), n), 1, 1e-6);
        EXPECT_NEAR(point.x[0] / taut, 1, 0.01);
        if (coefficient * angle > 1) continue;
        // Drawn less, it slips from both ends to a point between.
        const auto less = belt(n, angle, coefficient, 0.2 * taut, compliance);
        const auto partly = less.solve();
        EXPECT_TRUE(partly.converged) << "angle " << angle << ", coefficient " << coefficient << ", compliance " << compliance;
        EXPECT_LT(violation(less, partly), 1e-9);
      }
}

}  // namespace
}  // namespace mortise::qp
