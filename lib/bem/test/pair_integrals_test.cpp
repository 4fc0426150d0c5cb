#include "../src/pair_integrals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "surfaces.hpp"

namespace mortise::bem {
namespace {

// Two triangles, which need not close a surface.
Panels two_panels(const std::array<Point, 6>& corner)
{
  Panels panels;
  panels.points.assign(corner.begin(), corner.end());
  panels.corners = {{0, 1, 2}, {3, 4, 5}};
  for (std::size_t p = 0; p < 2; ++p) {
    const Point twice = (corner[3 * p + 1] - corner[3 * p]).cross(corner[3 * p + 2] - corner[3 * p]);
    panels.area.push_back(twice.norm() / 2);
    panels.normal.push_back(twice.normalized());
  }
  return panels;
}

PairIntegrals pair(const Panels& panels, std::size_t x, std::size_t y, double accuracy)
{
  PairIntegrals result;
  PairQuadrature(panels, accuracy).integrate(x, std::span(&y, 1), std::span(&result, 1));
  return result;
}

// The largest difference, over integrals of neighbours as large as the smaller panel.
double difference(const Panels& panels, const PairIntegrals& a, const PairIntegrals& b)
{
  const auto [small, large] = std::minmax(panels.area[0], panels.area[1]);
  const double single = small * std::sqrt(large) / (4 * std::numbers::pi), twofold = small / 6;
  double result = std::abs(a.single - b.single) / single;
  for (std::size_t c = 0; c < 6; ++c) result = std::max(result, std::abs(a.tensor[c] - b.tensor[c]) / single);
  for (std::size_t k = 0; k < 3; ++k)
    result =
        std::max({result, std::abs(a.double_x[k] - b.double_x[k]) / twofold, std::abs(a.double_y[k] - b.double_y[k]) / twofold});
  return result;
}

// Places of the second panel: parallel, slanted, in a plane that is at right angles, slender both, much smaller.
enum class Place { parallel, slanted, crossing, slender, small };
Panels close_panels(Place place, double gap, std::mt19937& random)
{
  std::uniform_real_distribution<double> any(-1, 1), positive(0, 1);
  for (;;) {
    std::array<Point, 6> x;
    for (auto& p : x) p = Point(any(random), any(random), 0);
    for (std::size_t k = 3; k < 6; ++k) {
      x[k][2] = gap + (place == Place::slanted ? positive(random) : 0);
      if (place == Place::small) x[k] = Point(0.02 * x[k][0], 0.02 * x[k][1], gap);
      if (place == Place::crossing) x[k] = Point(0, any(random), any(random));
    }
    if (place == Place::crossing) {
      const double most = std::max({x[0][0], x[1][0], x[2][0]});
      for (std::size_t k = 0; k < 3; ++k) x[k][0] -= most + gap;
    }
    const auto round = two_panels(x);
    if (round.area[0] < 0.1 || round.area[1] < (place == Place::small ? 4e-5 : 0.1)) continue;
    if (place != Place::slender) return round;
    for (auto& p : x) p[1] *= 0.01;
    return two_panels(x);
  }
}

TEST(PairIntegrals, OfClosePanelsAreAsExactAsAskedFor)
{
  std::mt19937 random(3);
  for (const auto place : {Place::parallel, Place::slanted, Place::crossing, Place::slender, Place::small})
    for (const double gap : {0.3, 0.03, 1e-3, 1e-5})
      for (int repeat = 0; repeat < 3; ++repeat) {
        const auto panels = close_panels(place, gap, random);
        EXPECT_LT(difference(panels, pair(panels, 0, 1, 1e-4), pair(panels, 0, 1, 1e-8)), 3e-4)
            << static_cast<int>(place) << ' ' << gap;
      }
}

// The same integrals with the roles of the panels changed, and by rules alone on small parts of both.
TEST(PairIntegrals, AgreeWithRulesOnSmallParts)
{
  std::mt19937 random(5);
  for (const auto place : {Place::parallel, Place::slanted, Place::crossing}) {
    const auto panels = close_panels(place, 0.3, random);
    constexpr int cuts = 12;
    PairIntegrals sum;
    const auto each = [&](std::size_t p, const auto& use) {
      const auto& rule = triangle_rule(3);
      const Point a = panels.corner(p, 0), u = (panels.corner(p, 1) - a) / cuts, v = (panels.corner(p, 2) - a) / cuts;
      for (int i = 0; i < cuts; ++i)
        for (int j = 0; i + j < cuts; ++j)
          for (const bool up : {true, false}) {
            if (!up && i + j == cuts - 1) continue;
            for (const auto& q : rule) {
              const double s = up ? i + q.at[1] : i + 1 - q.at[1], t = up ? j + q.at[2] : j + 1 - q.at[2];
              use(Point(a + s * u + t * v), std::array{1 - (s + t) / cuts, s / cuts, t / cuts},
                  q.weight * panels.area[p] / (cuts * cuts));
            }
          }
    };
    each(0, [&](const Point& x, const std::array<double, 3>& at_x, double wx) {
      each(1, [&](const Point& y, const std::array<double, 3>& at_y, double wy) {
        const Point d = x - y;
        const double r = d.norm(), g = wx * wy / (4 * std::numbers::pi * r), g3 = g / (r * r);
        sum.single += g;
        constexpr std::array<std::array<int, 2>, 6> places{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
        for (std::size_t c = 0; c < 6; ++c) sum.tensor[c] += g3 * d[places[c][0]] * d[places[c][1]];
        for (std::size_t k = 0; k < 3; ++k) {
          sum.double_y[k] += g3 * panels.normal[1].dot(d) * at_y[k];
          sum.double_x[k] -= g3 * panels.normal[0].dot(d) * at_x[k];
        }
      });
    });
    EXPECT_LT(difference(panels, pair(panels, 0, 1, 1e-7), sum), 1e-6) << static_cast<int>(place);
    auto turned = pair(panels, 1, 0, 1e-7);
    std::swap(turned.double_x, turned.double_y);
    EXPECT_LT(difference(panels, turned, sum), 1e-6) << static_cast<int>(place);
  }
}

// A slab's side, 1 : 40,000, and its top: seen from the edge, a face at right angles fills a quarter of all directions.
TEST(PairIntegrals, OfSlenderPanelsWithACommonEdge)
{
  auto panels =
      two_panels({Point(0, 0, 0), Point(0.4, 0, 0), Point(0, 0, -1e-5), Point(0, -0.2, 0), Point(0.4, 0, 0), Point(0, 0, 0)});
  panels.corners[1] = {3, 1, 0};
  const auto found = pair(panels, 0, 1, 1e-4);
  EXPECT_NEAR(std::abs(found.double_y[0] + found.double_y[1] + found.double_y[2]) / panels.area[0], 0.25, 1e-3);
}

std::size_t work(const Panels& panels)
{
  const PairQuadrature quadrature(panels, 1e-4);
  std::vector<std::size_t> others(panels.corners.size());
  std::iota(others.begin(), others.end(), 0U);
  std::vector<PairIntegrals> row(others.size());
  for (std::size_t x = 0; x < others.size(); ++x) quadrature.integrate(x, std::span(others).subspan(x), row);
  return quadrature.evaluations();
}

// Points grow like the pairs however slender or thin, not like powers of the ratio of the sides.
TEST(PairIntegrals, WorkIsBounded)
{
  const auto bounded = [](const Panels& panels, double most) {
    const auto m = static_cast<double>(panels.corners.size());
    EXPECT_LT(static_cast<double>(work(panels)), most * m * m) << m;
  };
  bounded(test::box({4, 4, 4}, Point(1, 1, 1)), 40);
  bounded(test::box({2, 20, 2}, Point(2, 1, 1)), 150);
  bounded(test::box({3, 3, 3}, Point(2, 1, 1e-3)), 1500);
  bounded(test::box({3, 3, 3}, Point(2, 1, 1e-5)), 1500);
}

}  // namespace
}  // namespace mortise::bem
