#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bem/boundary_operators.hpp"
#include "bem/representation.hpp"
#include "bem/surface_stress.hpp"
#include "line_integrals.hpp"
#include "recovered_stress.hpp"

namespace mortise::bem {

namespace {

constexpr double on_a_node = 1e-12;  // of a panel's length: logarithms nearer to its ends are those of this distance

template <class Vector>
Complex number(const Vector& v)
{
  return {v[0], v[1]};
}

// From a, along a unit vector; the inside is at the left.
struct Segment {
  Complex a, along;
  double length;
};
Segment segment(const PlanePanels& panels, std::size_t p)
{
  const Complex a = number(panels.corner(p, 0));
  return {a, (number(panels.corner(p, 1)) - a) / panels.area[p], panels.area[p]};
}

// x in the coordinates of a segment: along it from a, and to its left.
Complex place(const Segment& segment, Complex x)
{
  return (x - segment.a) * std::conj(segment.along);
}

Complex logarithm(Complex q)
{
  return {std::log(std::norm(q)) / 2, std::arg(q)};
}

// With q the place of x and s along the segment.
struct SegmentIntegrals {
  Complex pole;       // I 1 / (q - s)
  Complex moment;     // I s / (q - s) + length
  double logarithm;   // I ln |q - s|
  Complex turn;       // I (q - s) / conj(q - s)
  Complex turn_rate;  // its derivative by conj(q), times -1
};
// q and q - length lie on the same side of the segment: the logarithms' branches are the same.
SegmentIntegrals integrate(Complex q, double length)
{
  const auto end = [&](Complex at) { return std::abs(at) < on_a_node * length ? Complex(0, on_a_node * length) : at; };
  const Complex from = end(q), to = end({q.real() - length, q.imag()});  // keeps the sign of a zero
  const Complex at_begin = logarithm(from), at_end = logarithm(to), pole = at_begin - at_end;
  const Complex across(0, 2 * q.imag());
  return {pole, q * pole, (from * at_begin - to * at_end).real() - length, length + across * std::conj(pole),
          std::conj(pole) + across * std::conj(1.0 / to - 1.0 / from)};
}

// Of a panel, less the linear field of another: t - 2 mu m, du / ds and u in its begin.
struct Rest {
  Complex force, slope, u;
};

// With d = x - y, 1 / (2 pi) left out; by x and its conjugate the derivatives, in whose sum over a closed curve m and the double
// layer are one.
struct Gathered {
  Complex displacement, by_x, by_conjugate;

  void add(const Segment& panel, const Rest& rest, Complex x, double diagonal, double scale, double log_of_unit)
  {
    const Complex tau = panel.along, f = rest.force, g = rest.slope, unit(0, 1);
    const auto of = integrate(place(panel, x), panel.length);
    const double single = of.logarithm - panel.length * log_of_unit;
    displacement += scale * (-diagonal * f * single + (std::conj(f) * tau * tau * of.turn + f * panel.length) / 2.0) -
                    unit * g * single - rest.u * of.pole.imag() - g * of.moment.imag();
    const Complex conjugate = tau * std::conj(of.pole);
    by_x += scale / 2 * (std::conj(f) * conjugate - diagonal * f * std::conj(conjugate));
    by_conjugate -= scale / 2 * (diagonal * f * conjugate + std::conj(f) * tau * tau * tau * of.turn_rate) + unit * g * conjugate;
  }
};

}  // namespace

Representation<2>::Representation(const PlanePanels& panels, const fem::Material& material)
    : panels_(panels), material_(material), recovery_(panels, material), unit_(unit_of_length(panels))
{
}

Representation<2>::Nearest Representation<2>::nearest(const Point& x) const
{
  Nearest result{0, std::numeric_limits<double>::infinity()};
  for (std::size_t p = 0; p < panels_.corners.size(); ++p) {
    const Segment own = segment(panels_, p);
    const Complex q = place(own, number(x));
    const double squared = std::norm(q - std::clamp(q.real(), 0.0, own.length));
    if (squared < result.squared_distance) result = {p, squared};
  }
  return result;
}

Location Representation<2>::locate(const Point& x) const
{
  const auto [panel, squared_distance] = nearest(x);
  double angle = 0;
  for (std::size_t p = 0; p < panels_.corners.size(); ++p) {
    const Segment own = segment(panels_, p);
    angle += integrate(place(own, number(x)), own.length).pole.imag();
  }
  return {angle < -std::numbers::pi, std::sqrt(squared_distance), panel};
}

InteriorField Representation<2>::evaluate(std::span<const Point> points, const Eigen::VectorXd& u, const Eigen::VectorXd& t) const
{
  const double nu = material_.poisson_ratio, mu = material_.young_modulus / (2 * (1 + nu));
  const double diagonal = 3 - 4 * nu, scale = 1 / (4 * mu * (1 - nu)), log_of_unit = std::log(unit_);
  const std::size_t size = panels_.corners.size();
  const auto at_node = [&](std::size_t p, std::size_t k) { return number(u.segment<2>(2 * panels_.corners[p][k])); };
  std::vector<Segment> segments;
  std::vector<Complex> slopes;
  for (std::size_t p = 0; p < size; ++p) {
    segments.push_back(segment(panels_, p));
    slopes.push_back((at_node(p, 1) - at_node(p, 0)) / panels_.area[p]);
  }
  RecoveredStress recovered(panels_, recovery_, u, t);
  InteriorField result{Eigen::MatrixXd::Zero(points.size(), 3), Eigen::MatrixXd(points.size(), 6)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& x = points[i];
    const auto [nearby, squared_distance] = nearest(x);
    const Eigen::Matrix3d linear = panel_gradient(panels_, material_, nearby, u, t), stress_there = hooke(material_, linear);
    const Complex origin = segments[nearby].a, offset = at_node(nearby, 0);
    const auto times = [](const Eigen::Matrix3d& tensor, Complex v) {
      return number(Point(tensor * Point(v.real(), v.imag(), 0)));
    };
    Gathered sum{};
    for (std::size_t p = 0; p < size; ++p) {
      if (p == nearby) continue;  // nothing is left of it
      const Segment& own = segments[p];
      Rest rest{number(t.segment<2>(2 * static_cast<Eigen::Index>(p))) - times(stress_there, number(panels_.normal[p])),
                slopes[p] - times(linear, own.along), at_node(p, 0) - offset - times(linear, own.a - origin)};
      rest.force -= 2 * mu * Complex(0, 1) * rest.slope;
      sum.add(own, rest, number(x), diagonal, scale, log_of_unit);
    }
    const Complex displacement = sum.displacement / (2 * std::numbers::pi) + offset + times(linear, number(x) - origin);
    const Complex along_x = (sum.by_x + sum.by_conjugate) / (2 * std::numbers::pi),
                  along_y = Complex(0, 1) * (sum.by_x - sum.by_conjugate) / (2 * std::numbers::pi);
    Eigen::Matrix3d gradient = linear;
    gradient.topLeftCorner<2, 2>() += Eigen::Matrix2d{{along_x.real(), along_y.real()}, {along_x.imag(), along_y.imag()}};
    fem::Stress stress = components(hooke(material_, gradient));
    if (const double s = std::sqrt(squared_distance) / panels_.area[nearby]; s < 1) {
      const Segment& own = segments[nearby];
      const double at = std::clamp(place(own, number(x)).real() / own.length, 0.0, 1.0);
      stress += share_of_recovered(s) * (recovered.at(x, nearby, {1 - at, at}) - stress);
    }
    const auto row = static_cast<Eigen::Index>(i);
    result.displacement.row(row).head<2>() << displacement.real(), displacement.imag();
    result.stress.row(row) = stress;
  }
  return result;
}

}  // namespace mortise::bem
