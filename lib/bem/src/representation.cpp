#include "bem/representation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "bem/surface_stress.hpp"
#include "panel_potentials.hpp"
#include "rules.hpp"

namespace mortise::bem {

namespace {

// Errors of the rules in the integrals of d / r^3 and 3 d d'd / r^5 over a panel whose radius is t times its distance: below
// factor * t^power for t < 1/2 (measured on triangles of all directions). Those of a panel that is near are of the order of 1.
struct FieldRuleError {
  double factor;
  int power;
};
constexpr std::array<FieldRuleError, 4> field_rule_errors{{{0.35, 5}, {0.12, 7}, {0.027, 9}, {0.008, 9}}};
constexpr double largest_ratio = 0.5;

// The place of a point on a curve that fills the box [0, 1)^3, in an order that keeps neighbours together.
std::uint64_t place_on_curve(const Point& x)
{
  std::uint64_t place = 0;
  std::array<std::uint64_t, 3> at;
  for (std::size_t c = 0; c < 3; ++c) at[c] = static_cast<std::uint64_t>(std::clamp(x[static_cast<int>(c)], 0.0, 1.0) * 1023);
  for (int bit = 9; bit >= 0; --bit)
    for (std::size_t c = 0; c < 3; ++c) place = 2 * place + (at[c] >> bit & 1);
  return place;
}

// [Ericson, Real-time collision detection, 2005, section 5.1.5]
double squared_distance(const Point& x, const Point& a, const Point& b, const Point& c)
{
  const Point ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax), d3 = ab.dot(bx), d4 = ac.dot(bx), d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d1 <= 0 && d2 <= 0) return ax.squaredNorm();
  if (d3 >= 0 && d4 <= d3) return bx.squaredNorm();
  if (d6 >= 0 && d5 <= d6) return cx.squaredNorm();
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ax - d1 / (d1 - d3) * ab).squaredNorm();
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ax - d2 / (d2 - d6) * ac).squaredNorm();
  if (va <= 0 && d4 >= d3 && d5 >= d6) return (bx - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).squaredNorm();
  const Point n = ab.cross(ac);
  const double h = n.dot(ax);
  return h * h / n.squaredNorm();
}

// Area coordinates of the point of a triangle that is nearest to x.
std::array<double, 3> nearest_point(const Point& x, const Point& a, const Point& b, const Point& c)
{
  const auto along = [&x](const Point& from, const Point& to) {
    return std::clamp((x - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
  };
  const Point n = (b - a).cross(c - a);
  const double twice = n.squaredNorm(), wa = n.dot((c - b).cross(x - b)) / twice, wb = n.dot((a - c).cross(x - c)) / twice;
  if (wa >= 0 && wb >= 0 && wa + wb <= 1) return {wa, wb, 1 - wa - wb};
  const double ab = along(a, b), bc = along(b, c), ca = along(c, a);
  const std::array<std::array<double, 3>, 3> edges{{{1 - ab, ab, 0}, {0, 1 - bc, bc}, {ca, 0, 1 - ca}}};
  return *std::min_element(edges.begin(), edges.end(), [&](const auto& v, const auto& w) {
    const auto squared = [&](const auto& at) { return (at[0] * a + at[1] * b + at[2] * c - x).squaredNorm(); };
    return squared(v) < squared(w);
  });
}

// K n - tr(K) n with K = gradient', the operator M on a linear field.
Eigen::Matrix3d tangential(const Eigen::Matrix3d& gradient)
{
  return gradient.transpose() - gradient.trace() * Eigen::Matrix3d::Identity();
}

}  // namespace

// What one point gathers.
struct Representation<3>::Sum {
  Lane3 displacement;
  std::array<Lane3, 3> gradient;
  // of panels in closed form
  Point near_displacement = Point::Zero();
  Eigen::Matrix3d near_gradient = Eigen::Matrix3d::Zero();
  double scale;     // 1 / (4 (1 - nu)) / mu: of 1 / (4 pi) in U
  double diagonal;  // 3 - 4 nu

  Sum(double mu, double nu) : scale(1 / (4 * mu * (1 - nu))), diagonal(3 - 4 * nu)
  {
    for (auto& v : displacement) v.setZero();
    for (auto& row : gradient)
      for (auto& v : row) v.setZero();
  }
};

Representation<3>::Representation(const Panels& panels, const fem::Material& material, double accuracy)
    : panels_(panels), material_(material)
{
  for (std::size_t r = 0; r < rules; ++r)
    largest_[r] = std::min(largest_ratio, std::pow(accuracy / field_rule_errors[r].factor, 1.0 / field_rule_errors[r].power));

  Point low = panels.points.front(), high = low;
  for (const auto& p : panels.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const std::size_t size = panels.corners.size();
  const auto centre = [&](std::size_t p) { return Point((panels.corner(p, 0) + panels.corner(p, 1) + panels.corner(p, 2)) / 3); };
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t p = 0; p < size; ++p) order.emplace_back(place_on_curve((centre(p) - low) / (high - low).maxCoeff()), p);
  std::sort(order.begin(), order.end());

  for (std::size_t first = 0; first < size; first += lanes) {
    Block& block = blocks_.emplace_back();
    block.size = static_cast<int>(std::min<std::size_t>(lanes, size - first));
    for (int l = 0; l < lanes; ++l) {
      const std::size_t p = order[std::min(first + static_cast<std::size_t>(l), size - 1)].second;
      block.panel[static_cast<std::size_t>(l)] = p;
      const Point at = centre(p);
      for (std::size_t c = 0; c < 3; ++c) {
        block.centre[c][l] = at[static_cast<int>(c)];
        block.normal[c][l] = panels.normal[p][static_cast<int>(c)];
      }
      block.offset[l] = panels.normal[p].dot(at);
      block.area[l] = l < block.size ? panels.area[p] : 0;
      block.radius[l] = 0;
      for (int k = 0; k < 3; ++k) block.radius[l] = std::max(block.radius[l], (panels.corner(p, k) - at).norm());
    }
    for (int r = 0; r < rules; ++r)
      for (const auto& [at, weight] : triangle_rule(r)) {
        Lane3& y = points_[static_cast<std::size_t>(r)].emplace_back();
        for (int l = 0; l < lanes; ++l) {
          const std::size_t p = block.panel[static_cast<std::size_t>(l)];
          const Point q = at[0] * panels.corner(p, 0) + at[1] * panels.corner(p, 1) + at[2] * panels.corner(p, 2);
          for (std::size_t c = 0; c < 3; ++c) y[c][l] = q[static_cast<int>(c)];
        }
      }
  }
}

Representation<3>::Nearest Representation<3>::nearest(const Point& x) const
{
  // Some point of a panel is no farther than the panel's centre, and none nearer than that by its radius.
  std::vector<Lane> distance(blocks_.size());
  double farthest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto& [c0, c1, c2] = blocks_[b].centre;
    distance[b] = ((c0 - x[0]).square() + (c1 - x[1]).square() + (c2 - x[2]).square()).sqrt();
    farthest = std::min(farthest, distance[b].minCoeff());
  }
  Nearest result{blocks_.front().panel[0], std::numeric_limits<double>::infinity()};
  double bound = farthest * (1 + 1e-12);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    if ((distance[b] - block.radius).minCoeff() > bound) continue;
    for (int l = 0; l < block.size; ++l) {
      if (distance[b][l] - block.radius[l] > bound) continue;
      const std::size_t p = block.panel[static_cast<std::size_t>(l)];
      const double squared = squared_distance(x, panels_.corner(p, 0), panels_.corner(p, 1), panels_.corner(p, 2));
      if (squared >= result.squared_distance) continue;
      result = {p, squared};
      bound = std::min(bound, std::sqrt(squared) * (1 + 1e-12));
    }
  }
  return result;
}

int Representation<3>::rule_for(const Block& block, const Point& x) const
{
  const auto& [c0, c1, c2] = block.centre;
  const double ratio = (block.radius.square() / ((c0 - x[0]).square() + (c1 - x[1]).square() + (c2 - x[2]).square())).maxCoeff();
  int rule = 0;
  while (rule < rules && !(ratio < largest_[static_cast<std::size_t>(rule)] * largest_[static_cast<std::size_t>(rule)])) ++rule;
  return rule;
}

Location Representation<3>::locate(const Point& x) const
{
  const Nearest found = nearest(x);
  double angle = 0;
  for (const auto& block : blocks_) {
    const auto& [c0, c1, c2] = block.centre;
    const auto& [n0, n1, n2] = block.normal;
    const Lane squared = (c0 - x[0]).square() + (c1 - x[1]).square() + (c2 - x[2]).square();
    // From afar the centre stands for the panel: relative errors are below (radius / distance)^2.
    if ((block.radius.square() < 0.01 * squared).all()) {
      angle += (block.area * (n0 * x[0] + n1 * x[1] + n2 * x[2] - block.offset) / (squared * squared.sqrt())).sum();
      continue;
    }
    for (int l = 0; l < block.size; ++l) angle += solid_angle(panels_, block.panel[static_cast<std::size_t>(l)], x);
  }
  return {angle < -2 * std::numbers::pi, std::sqrt(found.squared_distance), found.panel};
}

std::vector<Representation<3>::Fields> Representation<3>::fields(const Eigen::VectorXd& u, const Eigen::VectorXd& t) const
{
  const double mu = material_.young_modulus / (2 * (1 + material_.poisson_ratio));
  std::vector<Fields> result(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int l = 0; l < lanes; ++l) {
      const std::size_t p = blocks_[b].panel[static_cast<std::size_t>(l)];
      Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
      Point mean = Point::Zero();
      for (int k = 0; k < 3; ++k) {
        const Point value = u.segment<3>(3 * panels_.corners[p][static_cast<std::size_t>(k)]);
        gradient += value * panels_.gradient(p, k).transpose();
        mean += value / 3;
      }
      const Point moment = tangential(gradient) * panels_.normal[p];
      const Point force = t.segment<3>(3 * static_cast<Eigen::Index>(p)) - 2 * mu * moment;
      Fields& f = result[b];
      for (std::size_t c = 0; c < 3; ++c) {
        const int i = static_cast<int>(c);
        f.u[c][l] = mean[i];
        f.moment[c][l] = moment[i];
        f.force[c][l] = force[i];
        for (std::size_t j = 0; j < 3; ++j) f.gradient[c][j][l] = gradient(i, static_cast<int>(j));
      }
    }
  return result;
}

void Representation<3>::add_far(std::size_t index, int rule_index, const Fields& rest, const Point& x, Sum& sum) const
{
  const Block& block = blocks_[index];
  const auto& rule = triangle_rule(rule_index);
  const Lane3* y = points_[static_cast<std::size_t>(rule_index)].data() + index * rule.size();
  const auto& [f0, f1, f2] = rest.force;
  Lane single = Lane::Zero(), cube = single, a0 = single, a1 = single, a2 = single, t0 = single, t1 = single, t2 = single;
  Lane e00 = single, e11 = single, e22 = single, e01 = single, e12 = single, e02 = single;
  for (std::size_t q = 0; q < rule.size(); ++q) {
    const Lane d0 = x[0] - y[q][0], d1 = x[1] - y[q][1], d2 = x[2] - y[q][2];
    const Lane inverse = 1 / (d0 * d0 + d1 * d1 + d2 * d2).sqrt(), square = inverse * inverse;
    const Lane g = rule[q].weight * inverse, g3 = g * square;
    single += g;
    cube += g3;
    a0 += g3 * d0;
    a1 += g3 * d1;
    a2 += g3 * d2;
    const Lane along = g3 * (d0 * f0 + d1 * f1 + d2 * f2);
    t0 += along * d0;
    t1 += along * d1;
    t2 += along * d2;
    const Lane fifth = 3 * along * square, h0 = fifth * d0, h1 = fifth * d1;
    e00 += h0 * d0;
    e01 += h0 * d1;
    e02 += h0 * d2;
    e11 += h1 * d1;
    e12 += h1 * d2;
    e22 += fifth * d2 * d2;
  }
  const auto& [n0, n1, n2] = block.normal;
  const Lane height = n0 * x[0] + n1 * x[1] + n2 * x[2] - block.offset, angle = height * cube;
  const Lane3 attraction{a0, a1, a2}, tensor{t0, t1, t2};
  const std::array<Lane3, 3> triple{{{e00, e01, e02}, {e01, e11, e12}, {e02, e12, e22}}};
  const Lane trace = a0 * f0 + a1 * f1 + a2 * f2;
  Lane3 lever;  // I n.d (y - centre) / r^3
  for (std::size_t c = 0; c < 3; ++c) lever[c] = (x[static_cast<int>(c)] - block.centre[c]) * angle - height * attraction[c];
  for (std::size_t j = 0; j < 3; ++j) {
    const Lane3& row = rest.gradient[j];
    const Lane turned = row[0] * a0 + row[1] * a1 + row[2] * a2;
    sum.displacement[j] +=
        block.area * (sum.scale * (sum.diagonal * single * rest.force[j] + tensor[j]) + single * rest.moment[j] -
                      angle * rest.u[j] - row[0] * lever[0] - row[1] * lever[1] - row[2] * lever[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      Lane kelvin = attraction[j] * rest.force[i] - sum.diagonal * rest.force[j] * attraction[i] - triple[i][j];
      if (i == j) kelvin += trace;
      sum.gradient[j][i] +=
          block.area * (sum.scale * kelvin - rest.moment[j] * attraction[i] - angle * row[i] + turned * block.normal[i]);
    }
  }
}

void Representation<3>::add_near(const Block& block, const Fields& rest, const Point& x, Sum& sum) const
{
  for (int l = 0; l < block.size; ++l) {
    const std::size_t p = block.panel[static_cast<std::size_t>(l)];
    const auto vector = [l](const Lane3& v) { return Point(v[0][l], v[1][l], v[2][l]); };
    const Point force = vector(rest.force), moment = vector(rest.moment), &n = panels_.normal[p];
    Eigen::Matrix3d gradient;
    for (int j = 0; j < 3; ++j) gradient.row(j) = vector(rest.gradient[static_cast<std::size_t>(j)]);
    const PanelPotentials of = panel_potentials(panels_, p, x, force);
    const Point& a = of.attraction;
    const Point from_centre = x - vector(block.centre);
    const double height = n.dot(from_centre);
    sum.near_displacement += sum.scale * (sum.diagonal * of.single * force + of.tensor) + of.single * moment -
                             of.angle * vector(rest.u) - gradient * (from_centre * of.angle - height * a);
    sum.near_gradient += sum.scale * (force * a.transpose() * -sum.diagonal + a * force.transpose() - of.triple) -
                         moment * a.transpose() - of.angle * gradient + gradient * a * n.transpose();
    sum.near_gradient.diagonal().array() += sum.scale * a.dot(force);
  }
}

InteriorField Representation<3>::evaluate(std::span<const Point> points, const Eigen::VectorXd& u, const Eigen::VectorXd& t,
                                          std::span<const LinearStress> recovered) const
{
  const double nu = material_.poisson_ratio, mu = material_.young_modulus / (2 * (1 + nu));
  const auto all = fields(u, t);
  // In x, whose nearest panel is p.
  const auto recovered_at = [&](const Point& x, std::size_t p) {
    const auto at = nearest_point(x, panels_.corner(p, 0), panels_.corner(p, 1), panels_.corner(p, 2));
    fem::Stress stress = fem::Stress::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Local node = panels_.corners[p][k];
      const auto& [constant, slope] = recovered[static_cast<std::size_t>(node)];
      stress += at[k] * (constant + slope * (x - panels_.corner(p, static_cast<int>(k))));
    }
    return stress;
  };
  InteriorField result{Eigen::MatrixXd(points.size(), 3), Eigen::MatrixXd(points.size(), 6)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& x = points[i];
    const auto [p, squared_distance] = nearest(x);
    const Point& origin = panels_.corner(p, 0);
    const Point offset = u.segment<3>(3 * panels_.corners[p][0]);
    const Eigen::Matrix3d linear = panel_gradient(panels_, material_, p, u, t), turned = tangential(linear),
                          forced = hooke(material_, linear) - 2 * mu * turned;
    Sum sum(mu, nu);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      const Fields& f = all[b];
      Fields rest;
      const auto& [n0, n1, n2] = block.normal;
      for (std::size_t c = 0; c < 3; ++c) {
        const int k = static_cast<int>(c);
        for (std::size_t j = 0; j < 3; ++j) rest.gradient[c][j] = f.gradient[c][j] - linear(k, static_cast<int>(j));
        rest.force[c] = f.force[c] - forced(k, 0) * n0 - forced(k, 1) * n1 - forced(k, 2) * n2;
        rest.moment[c] = f.moment[c] - turned(k, 0) * n0 - turned(k, 1) * n1 - turned(k, 2) * n2;
        rest.u[c] = f.u[c] - offset[k] - linear(k, 0) * (block.centre[0] - origin[0]) -
                    linear(k, 1) * (block.centre[1] - origin[1]) - linear(k, 2) * (block.centre[2] - origin[2]);
      }
      if (const int rule = rule_for(block, x); rule < rules)
        add_far(b, rule, rest, x, sum);
      else
        add_near(block, rest, x, sum);
    }
    Point displacement = sum.near_displacement;
    Eigen::Matrix3d gradient = sum.near_gradient;
    for (std::size_t j = 0; j < 3; ++j) {
      displacement[static_cast<int>(j)] += sum.displacement[j].sum();
      for (std::size_t k = 0; k < 3; ++k) gradient(static_cast<int>(j), static_cast<int>(k)) += sum.gradient[j][k].sum();
    }
    displacement = displacement / (4 * std::numbers::pi) + offset + linear * (x - origin);
    fem::Stress stress = components(hooke(material_, linear + gradient / (4 * std::numbers::pi)));
    if (const double s = std::sqrt(squared_distance / (2 * panels_.area[p])); s < 1)
      stress += (1 - s * s * (3 - 2 * s)) * (recovered_at(x, p) - stress);
    result.displacement.row(static_cast<Eigen::Index>(i)) = displacement;
    result.stress.row(static_cast<Eigen::Index>(i)) = stress;
  }
  return result;
}

}  // namespace mortise::bem
