#include "panel_potentials.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::bem {

namespace {

// log((b + |(b, r0)|) / (a + |(a, r0)|)) without cancellation, for a < b.
double log_ratio(double a, double b, double at_a, double at_b, double squared)
{
  if (a >= 0) return std::log((b + at_b) / (a + at_a));
  if (b <= 0) return std::log((at_a - a) / (at_b - b));
  return std::log((b + at_b) * (at_a - a) / squared);
}

// The edge from corner k to the next, of a panel over whose plane x is at the height h. With s along it from x's projection:
struct EdgeSeen {
  Point tau, nu;           // along it; across it in the plane, outward
  double length, p;        // of the edge; of x's projection from it, along nu
  double s0, s1;           // of its ends
  double squared, r0, r1;  // distance of x from its line, squared; from its ends
  double f;                // I 1 / r along it
};
EdgeSeen edge_seen_from(const Point& x, double h, const Panels& panels, std::size_t panel, int k)
{
  const Point first = panels.corner(panel, k) - x, edge = panels.corner(panel, (k + 1) % 3) - panels.corner(panel, k);
  const double length = edge.norm();
  const Point tau = edge / length, nu = tau.cross(panels.normal[panel]);
  const double p = nu.dot(first), s0 = tau.dot(first), s1 = s0 + length;
  const double squared = std::max(p * p + h * h, 1e-24 * length * length);
  const double r0 = std::sqrt(s0 * s0 + squared), r1 = std::sqrt(s1 * s1 + squared);
  return {tau, nu, length, p, s0, s1, squared, r0, r1, log_ratio(s0, s1, r0, r1, squared)};
}

}  // namespace

double solid_angle(const Panels& panels, std::size_t panel, const Point& x)
{
  const Point a = panels.corner(panel, 0) - x, b = panels.corner(panel, 1) - x, c = panels.corner(panel, 2) - x;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double determinant = -2 * panels.area[panel] * panels.normal[panel].dot(a);
  return 2 * std::atan2(determinant, la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

LayerPotentials layer_potentials(const Panels& panels, std::size_t panel, const Point& x)
{
  const Point& n = panels.normal[panel];
  const double h = n.dot(x - panels.corner(panel, 0)), angle = solid_angle(panels, panel, x);
  double single = -h * angle;
  Point b = Point::Zero();
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  std::array<double, 3> beyond{};  // twice the area of x's projection with each edge
  std::array<Point, 3> normals;    // of the edges, as long as these
  for (int k = 0; k < 3; ++k) {
    const auto [tau, nu, length, p, s0, s1, squared, r0, r1, f] = edge_seen_from(x, h, panels, panel, k);
    single += p * f;
    b -= f * nu;
    edges += nu * (p * f * nu + (r1 - r0) * tau).transpose();
    beyond[static_cast<std::size_t>(k)] = p * length;
    normals[static_cast<std::size_t>(k)] = length * nu;
  }
  const double lift = h * angle - single;
  const auto entry = [&](int i, int j) {
    return lift * n[i] * n[j] - h * (n[i] * b[j] + b[i] * n[j]) - (edges(i, j) + edges(j, i)) / 2 + (i == j ? single : 0);
  };
  LayerPotentials result{
      single, {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)}, angle * n - b, {}};
  // phi falls from 1 in corner k to 0 on the edge opposite, whose outward normal is nu: grad phi = -length nu / (2 area).
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t opposite = (k + 1) % 3;
    result.double_layer[k] = (beyond[opposite] * angle - h * normals[opposite].dot(b)) / (2 * panels.area[panel]);
  }
  return result;
}

PanelPotentials panel_potentials(const Panels& panels, std::size_t panel, const Point& x, const Point& c)
{
  const Point& n = panels.normal[panel];
  const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - n * n.transpose();
  const double h = n.dot(x - panels.corner(panel, 0)), normal = n.dot(c);
  const Point along = c - normal * n;
  const double angle = solid_angle(panels, panel, x);

  // I 1 / r + h angle; I rho / r^3; I rho / r along the edges, with their normals; and of the third powers.
  double single = 0, z = angle;
  Point b = Point::Zero(), y = Point::Zero();
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero(), cross = angle * plane, cubic = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto [tau, nu, length, p, s0, s1, squared, r0, r1, f] = edge_seen_from(x, h, panels, panel, k);
    // r0^2 I 1 / r^3; I s / r^3 and I s^2 / r^3 along the edge
    const double w = s1 / r1 - s0 / r0, e1 = 1 / r0 - 1 / r1, e2 = f - w, e0 = w / squared;
    single += p * f;
    b -= f * nu;
    edges += nu * (p * f * nu + (r1 - r0) * tau).transpose();
    z += h * p * e0;
    y -= h * h * e0 * nu;
    const Eigen::Matrix3d mixed = nu * tau.transpose();
    cross -= h * (p * e0 * nu * nu.transpose() + e1 / 2 * (mixed + mixed.transpose()));
    cubic -= nu.dot(c) * (p * p * e0 * nu * nu.transpose() + p * e1 * (mixed + mixed.transpose()) + e2 * tau * tau.transpose());
  }
  single -= h * angle;
  cubic += along * b.transpose() + b * along.transpose();

  PanelPotentials result;
  result.single = single;
  result.angle = angle;
  result.attraction = angle * n - b;
  result.tensor = (h * angle * normal - h * b.dot(along)) * n - h * normal * b + single * along - edges.transpose() * along;
  const Point mixed = cross * along;
  result.triple = (normal * z - y.dot(along)) * n * n.transpose() + n * (mixed - normal * y).transpose() +
                  (mixed - normal * y) * n.transpose() + normal * cross - cubic;
  return result;
}

}  // namespace mortise::bem
