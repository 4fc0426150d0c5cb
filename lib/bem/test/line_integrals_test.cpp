#include "../src/line_integrals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../src/rules.hpp"

namespace mortise::bem {
namespace {

double largest_of(const LineIntegrals& a, const LineIntegrals& b, double lengths, double length)
{
  double result = std::abs(a.single - b.single) / lengths;
  for (std::size_t c = 0; c < 3; ++c) result = std::max(result, std::abs(a.tensor[c] - b.tensor[c]) / lengths);
  for (std::size_t k = 0; k < 2; ++k)
    result =
        std::max({result, std::abs(a.double_x[k] - b.double_x[k]) / length, std::abs(a.double_y[k] - b.double_y[k]) / length});
  return result;
}

// Rules on halves of halves, until they are far from each other. `s`, `t`: the parts of the lines.
void add_by_halves(const Line& x, const Line& y, const std::array<double, 2>& s, const std::array<double, 2>& t, int depth,
                   LineIntegrals& sum)
{
  const Complex a = x.end - x.begin, b = y.end - y.begin;
  const double of_x = (s[1] - s[0]) * std::abs(a), of_y = (t[1] - t[0]) * std::abs(b);
  const auto at = [](const std::array<double, 2>& part, double place) { return part[0] + place * (part[1] - part[0]); };
  const Complex between = x.begin + at(s, 0.5) * a - y.begin - at(t, 0.5) * b;
  if (depth > 0 && std::abs(between) < 1.5 * (of_x + of_y)) {
    const bool both = of_x < 2 * of_y && of_y < 2 * of_x;
    for (const int i : {0, 1})
      for (const int j : {0, 1}) {
        std::array<double, 2> of_s = s, of_t = t;
        if (both || of_x >= of_y) of_s = {at(s, 0.5 * i), at(s, 0.5 * (i + 1))};
        if (both || of_y > of_x) of_t = {at(t, 0.5 * j), at(t, 0.5 * (j + 1))};
        if (both || (of_x >= of_y ? j : i) == 0) add_by_halves(x, y, of_s, of_t, depth - 1, sum);
      }
    return;
  }
  const Complex normal_x = Complex(0, -1) * a / std::abs(a), normal_y = Complex(0, -1) * b / std::abs(b);
  for (const auto& p : gauss(10))
    for (const auto& q : gauss(10)) {
      const double place_x = at(s, p.at), place_y = at(t, q.at), weight = p.weight * q.weight * of_x * of_y;
      const Complex d = x.begin + place_x * a - y.begin - place_y * b;
      const double squared = std::norm(d);
      sum.single += weight * std::log(squared) / 2;
      sum.tensor[0] += weight * d.real() * d.real() / squared;
      sum.tensor[1] += weight * d.imag() * d.imag() / squared;
      sum.tensor[2] += weight * d.real() * d.imag() / squared;
      const double at_x = -weight * std::real(std::conj(normal_x) * d) / squared,
                   at_y = weight * std::real(std::conj(normal_y) * d) / squared;
      sum.double_x[0] += (1 - place_x) * at_x;
      sum.double_x[1] += place_x * at_x;
      sum.double_y[0] += (1 - place_y) * at_y;
      sum.double_y[1] += place_y * at_y;
    }
}

TEST(LineIntegrals, AgainstRules)
{
  const Line unit{{0, 0}, {1, 0}};
  const std::vector<std::pair<Line, Line>> pairs{{unit, {{3, 1}, {2.5, 1.5}}},        // far
                                                 {unit, {{30, 10}, {29.5, 10.5}}},    // where rules take over
                                                 {unit, {{1, 1e-3}, {0, 1e-3}}},      // opposite, near
                                                 {unit, {{0.5, 1e-4}, {0.2, 0.7}}},   // ends near the middle
                                                 {unit, {{1, 0}, {1, 1}}},            // common end, square corner
                                                 {unit, {{1, 0}, {2.5, 0}}},          // one behind the other
                                                 {unit, {{-0.3, 0}, {0, 0}}},         //
                                                 {unit, {{1, 0}, {0.2, 0.02}}},       // sharp corner
                                                 {unit, {{1, 0}, {1 + 1e-3, 1e-3}}},  // unequal
                                                 {unit, {{0, 1e-3}, {0, 0}}},         //
                                                 {{{0.1, 0.7}, {-0.4, 0.2}}, {{-0.4, 0.2}, {0.3, -1}}},
                                                 {unit, {{0.4, 1e-5}, {0.4, 1e-5 + 2e-3}}}};
  for (const auto& [x, y] : pairs) {
    LineIntegrals exact;
    add_by_halves(x, y, {0, 1}, {0, 1}, 45, exact);
    const double of_x = std::abs(x.end - x.begin), of_y = std::abs(y.end - y.begin);
    EXPECT_LT(largest_of(integrate(x, y), exact, of_x * of_y, std::min(of_x, of_y)), 1e-10) << y.begin << y.end;
    auto mirrored = integrate(y, x);
    std::swap(mirrored.double_x, mirrored.double_y);
    EXPECT_LT(largest_of(mirrored, exact, of_x * of_y, std::min(of_x, of_y)), 1e-10) << y.begin << y.end;
  }
}

// A line of length 2 with itself: 4 (ln 2 - 3/2); and from its parts.
TEST(LineIntegrals, LineWithItself)
{
  const Complex direction = std::polar(1.0, 0.4), from(0.3, -0.2);
  const auto part = [&](double a, double b) { return Line{from + a * direction, from + b * direction}; };
  const auto whole = integrate(part(0, 2), part(0, 2));
  EXPECT_NEAR(whole.single, 4 * (std::log(2.0) - 1.5), 1e-14);
  EXPECT_NEAR(whole.tensor[0], 4 * std::pow(std::cos(0.4), 2), 1e-14);
  EXPECT_NEAR(whole.tensor[2], 4 * std::cos(0.4) * std::sin(0.4), 1e-14);
  for (const double cut : {1.0, 0.3, 1e-4}) {
    const auto a = part(0, cut), b = part(cut, 2);
    EXPECT_NEAR(integrate(a, a).single + integrate(b, b).single + 2 * integrate(a, b).single, whole.single, 1e-13) << cut;
    EXPECT_NEAR(integrate(a, a).tensor[0] + integrate(b, b).tensor[0] + 2 * integrate(a, b).tensor[0], whole.tensor[0], 1e-13);
    for (const double d : integrate(a, b).double_y) EXPECT_NEAR(d, 0, 1e-13);
  }
}

// Rules and closed forms, on both sides of where one takes over from the other.
TEST(LineIntegrals, FarLines)
{
  const Line x{{0, 0}, {1, 0.2}};
  for (const double distance : {20.0, 90.0, 110.0, 1e3, 1e5}) {
    const Line y{{0.3 * distance, distance}, {0.3 * distance + 0.5, distance - 1}};
    LineIntegrals exact;
    add_by_halves(x, y, {0, 1}, {0, 1}, 0, exact);
    EXPECT_LT(largest_of(integrate(x, y), exact, 1.0, 1.0), 1e-11) << distance;
  }
}

}  // namespace
}  // namespace mortise::bem
