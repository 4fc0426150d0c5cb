#include "line_integrals.hpp"

#include <cmath>

#include "rules.hpp"

namespace mortise::bem {

namespace {

constexpr double rounding = 1e-16;
constexpr double exact_enough = 1e-12;
constexpr int most_points = 8;

// Integrals over the unit square of x = begin + s a, y = begin + t b, with z = x - y:
// ln r, conj(z) / z, and in both directions the derivative of the angle times phi_k.
struct UnitIntegrals {
  double logarithm;
  Complex turn;
  std::array<double, 2> angle_x, angle_y;
};

// From the middle of y to that of x; nothing if they are the same line.
Complex between(const Line& x, const Line& y)
{
  return ((x.begin - y.begin) + (x.end - y.end)) / 2.0;
}

// II ln z and II conj(z) / z are twofold differences of their antiderivatives,
//
//     z^2 (ln z - 3/2) / 2   and   |z|^2 (ln z - 1) + (a conj(b) + b conj(a)) / (a b) z^2 (ln z - 3/2) / 2,
//
// over -a b. 0 is no inner point of the parallelogram of z, and so there is a half-plane that holds it: ln (z / centre) is
// continuous.
UnitIntegrals closed_form(const Line& x, const Line& y)
{
  const Complex a = x.end - x.begin, b = y.end - y.begin;
  const Complex centre = between(x, y);
  const double size = std::log(std::abs(centre)), cross = 2 * std::real(a * std::conj(b));
  std::array<std::array<Complex, 2>, 2> z, ln;
  Complex twofold_square = 0, twofold_norm = 0;
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t t = 0; t < 2; ++t) {
      z[s][t] = (s == 0 ? x.begin : x.end) - (t == 0 ? y.begin : y.end);
      ln[s][t] = z[s][t] == 0.0 ? 0.0 : std::log(z[s][t] / centre);
      const double sign = s == t ? 1 : -1;
      twofold_square += sign * z[s][t] * z[s][t] / 2.0 * ln[s][t];
      twofold_norm += sign * std::norm(z[s][t]) * ln[s][t];
    }
  const Complex mean = -1.5 - twofold_square / (a * b);  // of ln (z / centre)
  const auto primitive = [&](std::size_t s, std::size_t t) { return z[s][t] * (ln[s][t] - 1.0); };
  UnitIntegrals result{};
  result.logarithm = size + mean.real();
  result.turn = -(twofold_norm + cross * (1.0 + mean)) / (a * b);
  for (std::size_t k = 0; k < 2; ++k) {
    const double sign = k == 0 ? -1 : 1;
    result.angle_y[k] = sign * (std::imag((primitive(1, k) - primitive(0, k)) / a) - mean.imag());
    result.angle_x[k] = sign * (std::imag((primitive(k, 0) - primitive(k, 1)) / b) - mean.imag());
  }
  return result;
}

UnitIntegrals by_rule(const Line& x, const Line& y, int points)
{
  const Complex a = x.end - x.begin, b = y.end - y.begin;
  UnitIntegrals result{};
  for (const auto& s : gauss(points))
    for (const auto& t : gauss(points)) {
      const Complex z = x.begin + s.at * a - y.begin - t.at * b;
      const double weight = s.weight * t.weight, of_x = weight * std::imag(a / z), of_y = -weight * std::imag(b / z);
      result.logarithm += weight / 2 * std::log(std::norm(z));
      result.turn += weight * std::conj(z) / z;
      result.angle_x[0] += (1 - s.at) * of_x;
      result.angle_x[1] += s.at * of_x;
      result.angle_y[0] += (1 - t.at) * of_y;
      result.angle_y[1] += t.at * of_y;
    }
  return result;
}

UnitIntegrals of_itself(const Line& x)
{
  const Complex a = x.end - x.begin;
  return {std::log(std::abs(a)) - 1.5, std::conj(a) / a, {}, {}};
}

// Differences lose digits far away, and rules need few points there.
UnitIntegrals integrate_unit(const Line& x, const Line& y)
{
  const double of_x = std::abs(x.end - x.begin), of_y = std::abs(y.end - y.begin), distance = std::abs(between(x, y));
  if (distance == 0) return of_itself(x);
  const double lost = rounding * distance * distance / (of_x * of_y), ratio = std::max(of_x, of_y) / (2 * distance);
  const double points = std::ceil(std::log(exact_enough * 1e-2) / (2 * std::log(std::min(ratio, 0.5))));
  if (lost < exact_enough || points > most_points) return closed_form(x, y);
  return by_rule(x, y, static_cast<int>(points));
}

}  // namespace

LineIntegrals integrate(const Line& x, const Line& y)
{
  const auto unit = integrate_unit(x, y);
  const double of_x = std::abs(x.end - x.begin), of_y = std::abs(y.end - y.begin), both = of_x * of_y;
  LineIntegrals result;
  result.single = both * unit.logarithm;
  result.tensor = {both * (1 + unit.turn.real()) / 2, both * (1 - unit.turn.real()) / 2, -both * unit.turn.imag() / 2};
  for (std::size_t k = 0; k < 2; ++k) {
    result.double_x[k] = -of_y * unit.angle_x[k];
    result.double_y[k] = -of_x * unit.angle_y[k];
  }
  return result;
}

}  // namespace mortise::bem
