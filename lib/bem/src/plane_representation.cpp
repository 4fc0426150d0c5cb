#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

#include "bem/boundary_operators.hpp"
#include "bem/representation.hpp"
#include "bem/surface_stress.hpp"
#include "line_integrals.hpp"

namespace mortise::bem {

namespace {

constexpr double smooth = 0.8;          // cosine of the angle of neighbours at no corner
constexpr double beside_a_node = 0.05;  // of the shorter panel's length: no logarithm of a jump grows nearer to a node
constexpr double on_surface = 1e-8;     // of a panel's length: points nearer to it are moved to this distance inside

template <class Vector>
Complex number(const Vector& v)
{
  return {v[0], v[1]};
}

// Along a unit vector; the inside is at the left.
struct Segment {
  Complex middle, along;
  double length;
  std::array<double, 2> least{};  // see SegmentIntegrals
};
Segment segment(const PlanePanels& panels, std::size_t p)
{
  const Complex a = number(panels.corner(p, 0)), b = number(panels.corner(p, 1));
  return {(a + b) / 2.0, (b - a) / panels.area[p], panels.area[p], {}};
}

// x in the coordinates of a segment: along it from its middle, and to its left.
Complex place(const Segment& segment, Complex x)
{
  return (x - segment.middle) * std::conj(segment.along);
}

Complex logarithm(Complex q)
{
  return {std::log(std::norm(q)) / 2, std::arg(q)};
}

// With q the place of x and s along the segment, from its middle.
struct SegmentIntegrals {
  Complex angle, lever;            // I 1 / (q - s) and I s / (q - s)
  std::array<Complex, 2> pole;     // the same, of derivatives
  std::array<Complex, 2> squared;  // I 1 / (q - s)^2 and I s / (q - s)^2
  double logarithm;                // I ln |q - s|
  Complex turn;                    // I (q - s) / conj(q - s)
};
// q and its distances from the ends lie on the same side of the segment: the logarithms' branches are the same. `least`: nearer
// to the begin and the end logarithms of derivatives grow no more.
SegmentIntegrals integrate(Complex q, double length, const std::array<double, 2>& least)
{
  const Complex from(q.real() + length / 2, q.imag()), to(q.real() - length / 2, q.imag());  // which keeps the sign of a zero
  const Complex at_begin = logarithm(from), at_end = logarithm(to), pole = at_begin - at_end;
  const Complex across(0, 2 * q.imag());
  const auto beyond = [](Complex at, double limit) {
    return std::norm(at) < limit * limit ? std::log(limit / std::abs(at)) : 0.0;
  };
  const Complex limited = pole + beyond(from, least[0]) - beyond(to, least[1]);
  return {pole,
          q * pole - length,
          {limited, q * limited - length},
          {1.0 / to - 1.0 / from, length / 2 * (1.0 / to + 1.0 / from) - limited},
          (from * at_begin - to * at_end).real() - length,
          length + across * std::conj(pole)};
}

// Of a panel, less the linear field of another: t - 2 mu m and du / ds in its middle and their slopes, and u in its middle.
struct Rest {
  std::array<Complex, 2> force, slope;
  Complex u;
};

// With d = x - y, 1 / (2 pi) left out; by x and its conjugate the derivatives, in whose sum over a closed curve m and the double
// layer are one.
struct Gathered {
  Complex displacement, by_x, by_conjugate;

  // q: the place of x.
  void add(const Segment& panel, const Rest& rest, Complex q, double diagonal, double scale, double log_of_unit)
  {
    const Complex tau = panel.along, f = rest.force[0], g = rest.slope[0], unit(0, 1), across(0, 2 * q.imag());
    const auto of = integrate(q, panel.length, panel.least);
    const double single = of.logarithm - panel.length * log_of_unit;
    displacement += scale * (-diagonal * f * single + (std::conj(f) * tau * tau * of.turn + f * panel.length) / 2.0) -
                    unit * g * single - rest.u * of.angle.imag() - g * of.lever.imag();
    for (std::size_t k = 0; k < 2; ++k) {
      const Complex force = rest.force[k], turned = std::conj(force), pole = of.pole[k], conjugate = tau * std::conj(pole);
      by_x += scale / 2 * (turned * conjugate - diagonal * force * std::conj(tau) * pole);
      by_conjugate -=
          scale / 2 *
              (diagonal * force * conjugate + turned * tau * tau * (conjugate + tau * across * std::conj(of.squared[k]))) +
          unit * rest.slope[k] * conjugate;
    }
  }
};

// How a gradient changes along each panel: from those of the panel and its neighbours, as far as the surface is smooth there, at
// most twice the smaller one of the two differences, nothing at an extremum [van Leer, J. Comput. Phys. 23 (1977)].
std::vector<Eigen::Matrix3d> changes(const PlanePanels& panels, const std::vector<Eigen::Matrix3d>& gradients)
{
  struct Neighbours {
    std::size_t count = 0, before = 0, after = 0;
  };
  std::vector<Neighbours> nodes(panels.points.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    nodes[static_cast<std::size_t>(panels.corners[p][0])].after = p;
    auto& end = nodes[static_cast<std::size_t>(panels.corners[p][1])];
    end.before = p;
    ++end.count;
  }
  std::vector<std::optional<Eigen::Matrix3d>> at_node;  // the difference over the distance of the middles
  for (const auto& [count, before, after] : nodes) {
    auto& difference = at_node.emplace_back();
    if (count == 1 && panels.normal[before].dot(panels.normal[after]) > smooth)
      difference = (gradients[after] - gradients[before]) / ((panels.area[after] + panels.area[before]) / 2);
  }
  std::vector<Eigen::Matrix3d> result;
  for (const auto& [a, b] : panels.corners) {
    const auto &first = at_node[static_cast<std::size_t>(a)], &second = at_node[static_cast<std::size_t>(b)];
    auto& change = result.emplace_back(Eigen::Matrix3d::Zero());
    if (first && second)
      change = first->binaryExpr(*second, [](double l, double r) {
        return l * r <= 0 ? 0.0 : std::copysign(std::min({std::abs(l + r) / 2, 2 * std::abs(l), 2 * std::abs(r)}), l);
      });
    else if (first || second)
      change = first ? *first : *second;
  }
  return result;
}

}  // namespace

Representation<2>::Representation(const PlanePanels& panels, const fem::Material& material)
    : panels_(panels), material_(material), unit_(unit_of_length(panels)), around_(panels.points.size())
{
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) around_[static_cast<std::size_t>(c)].push_back(p);
}

Representation<2>::Nearest Representation<2>::nearest(const Point& x) const
{
  Nearest result{0, std::numeric_limits<double>::infinity()};
  for (std::size_t p = 0; p < panels_.corners.size(); ++p) {
    const Segment own = segment(panels_, p);
    const Complex q = place(own, number(x));
    const double squared = std::norm(q - std::clamp(q.real(), -own.length / 2, own.length / 2));
    if (squared < result.squared_distance) result = {p, squared};
  }
  return result;
}

bool Representation<2>::encloses(const Point& x) const
{
  double angle = 0;
  for (std::size_t p = 0; p < panels_.corners.size(); ++p) {
    const Segment own = segment(panels_, p);
    const Complex q = place(own, number(x));
    angle += std::arg(q + own.length / 2) - std::arg(q - own.length / 2);
  }
  return angle < -std::numbers::pi;
}

Location Representation<2>::locate(const Point& x) const
{
  const auto [panel, squared_distance] = nearest(x);
  return {encloses(x), std::sqrt(squared_distance), panel};
}

std::pair<Point, std::size_t> Representation<2>::evaluated_at(const Point& x) const
{
  const auto [p, squared_distance] = nearest(x);
  const double length = panels_.area[p], distance = std::sqrt(squared_distance);
  if (distance > on_surface * length && (distance > length || encloses(x))) return {x, p};
  const double s =
      std::clamp((x - panels_.corner(p, 0)).dot(panels_.corner(p, 1) - panels_.corner(p, 0)) / (length * length), 0.0, 1.0);
  Point inward = -panels_.normal[p];
  for (std::size_t k = 0; k < 2; ++k)
    if (std::abs(s - static_cast<double>(k)) < on_surface)
      for (const std::size_t other : around_[static_cast<std::size_t>(panels_.corners[p][k])])
        if (other != p) inward -= panels_.normal[other];
  const Point closest = panels_.corner(p, 0) + s * (panels_.corner(p, 1) - panels_.corner(p, 0));
  return {closest + on_surface * length * inward.normalized(), p};
}

InteriorField Representation<2>::evaluate(std::span<const Point> points, const Eigen::VectorXd& u, const Eigen::VectorXd& t) const
{
  const double nu = material_.poisson_ratio, mu = material_.young_modulus / (2 * (1 + nu));
  const double diagonal = 3 - 4 * nu, scale = 1 / (4 * mu * (1 - nu)), log_of_unit = std::log(unit_);
  const std::size_t size = panels_.corners.size();
  const auto at_node = [&](std::size_t p, std::size_t k) { return number(u.segment<2>(2 * panels_.corners[p][k])); };
  std::vector<Segment> segments;
  std::vector<Eigen::Matrix3d> gradients;
  for (std::size_t p = 0; p < size; ++p) {
    segments.push_back(segment(panels_, p));
    gradients.push_back(panel_gradient(panels_, material_, p, u, t));
  }
  const auto times = [](const Eigen::Matrix3d& tensor, const Point& v) { return number(Point(tensor * v)); };
  const auto point = [](Complex z) { return Point(z.real(), z.imag(), 0); };
  // What a gradient gives on a panel: du / ds and t - 2 mu m.
  const auto on_panel = [&](const Eigen::Matrix3d& gradient, std::size_t p) {
    const Complex slope = times(gradient, point(segments[p].along));
    return std::pair(slope, times(hooke(material_, gradient), panels_.normal[p]) - 2 * mu * Complex(0, 1) * slope);
  };
  for (std::size_t p = 0; p < size; ++p)
    for (std::size_t k = 0; k < 2; ++k) {
      double shortest = panels_.area[p];
      for (const std::size_t other : around_[static_cast<std::size_t>(panels_.corners[p][k])])
        shortest = std::min(shortest, panels_.area[other]);
      segments[p].least[k] = beside_a_node * shortest;
    }
  const auto change = changes(panels_, gradients);
  std::vector<Rest> all(size);
  for (std::size_t p = 0; p < size; ++p) {
    all[p].u = (at_node(p, 0) + at_node(p, 1)) / 2.0;
    for (std::size_t k = 0; k < 2; ++k)
      std::tie(all[p].slope[k], all[p].force[k]) = on_panel(k == 0 ? gradients[p] : change[p], p);
  }
  InteriorField result{Eigen::MatrixXd::Zero(points.size(), 3), Eigen::MatrixXd(points.size(), 6)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [x, nearby] = evaluated_at(points[i]);
    const Eigen::Matrix3d& linear = gradients[nearby];
    const Complex origin = segments[nearby].middle, offset = all[nearby].u;
    Gathered sum{};
    for (std::size_t p = 0; p < size; ++p) {
      Rest rest = all[p];
      const auto [slope, force] = on_panel(linear, p);
      rest.slope[0] -= slope;
      rest.force[0] -= force;
      rest.u -= offset + times(linear, point(segments[p].middle - origin));
      sum.add(segments[p], rest, place(segments[p], number(x)), diagonal, scale, log_of_unit);
    }
    const Complex displacement =
        sum.displacement / (2 * std::numbers::pi) + offset + times(linear, point(number(points[i]) - origin));
    const Complex along_x = (sum.by_x + sum.by_conjugate) / (2 * std::numbers::pi),
                  along_y = Complex(0, 1) * (sum.by_x - sum.by_conjugate) / (2 * std::numbers::pi);
    Eigen::Matrix3d gradient = linear;
    gradient.topLeftCorner<2, 2>() += Eigen::Matrix2d{{along_x.real(), along_y.real()}, {along_x.imag(), along_y.imag()}};
    const auto row = static_cast<Eigen::Index>(i);
    result.displacement.row(row).head<2>() << displacement.real(), displacement.imag();
    result.stress.row(row) = components(hooke(material_, gradient));
  }
  return result;
}

}  // namespace mortise::bem
