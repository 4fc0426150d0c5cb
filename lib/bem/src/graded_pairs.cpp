#include <algorithm>
#include <cmath>
#include <numbers>

#include "pair_integrals.hpp"
#include "panel_potentials.hpp"

namespace mortise::bem {

namespace {

constexpr int deepest_graded = 60;  // halvings of a panel
constexpr double least_part = 1.0;  // over the height of a panel and the accuracy

}  // namespace

// One panel by a rule, in parts, the other one in closed form. The potentials of a triangle are smooth but at its edges, above
// and below its inside as well, and along an edge as far as its ends are. So a part is halved that is wide for its distance from
// an edge, or long for that from an end.
struct PairQuadrature::Graded {
  using Triangle = std::array<Point, 3>;

  const Panels& panels;
  std::size_t outer, inner;
  double accuracy, least;  // the distance from an edge at which parts are no longer halved for it
  std::array<double, triangle_rules> steepest;
  PairIntegrals& sum;  // outer panel: x
  std::size_t& evaluations;

  static double to_segment(const Point& x, const Point& a, const Point& b)
  {
    const Point ab = b - a;
    return (a + std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) * ab - x).norm();
  }
  // Between segments a + s u and b + t v [Ericson, Real-Time Collision Detection, 2005, section 5.1.9].
  static double between_segments(const Point& a, const Point& u, const Point& b, const Point& v)
  {
    const Point r = a - b;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
    const double determinant = uu * vv - uv * uv;
    double s = determinant > 1e-14 * uu * vv ? std::clamp((uv * vr - ur * vv) / determinant, 0.0, 1.0) : 0.0;
    double t = (uv * s + vr) / vv;
    if (t < 0 || t > 1) {
      t = std::clamp(t, 0.0, 1.0);
      s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
    }
    return (r + s * u - t * v).norm();
  }
  static double to_triangle(const Triangle& t, const Point& n, const Point& x)
  {
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) inside = inside && n.cross(t[(k + 1) % 3] - t[k]).dot(x - t[k]) >= 0;
    if (inside) return std::abs(n.dot(x - t[0]));
    return std::min({to_segment(x, t[0], t[1]), to_segment(x, t[1], t[2]), to_segment(x, t[2], t[0])});
  }

  // How fast the potentials may vary over a part, and the side of it along which they do most.
  std::pair<double, std::size_t> steepness(const Triangle& part) const
  {
    const Point& n = panels.normal[outer];
    std::array<double, 3> to_end{};
    for (std::size_t k = 0; k < 3; ++k) to_end[k] = to_triangle(part, n, panels.corner(inner, static_cast<int>(k)));
    std::pair<double, std::size_t> result{0, 0};
    for (std::size_t e = 0; e < 3; ++e) {
      const Point a = panels.corner(inner, static_cast<int>(e)), b = panels.corner(inner, static_cast<int>((e + 1) % 3)),
                  u = b - a;
      const double end = std::min(to_end[e], to_end[(e + 1) % 3]);
      double edge = end;
      for (std::size_t k = 0; k < 3; ++k) edge = std::min(edge, between_segments(a, u, part[k], part[(k + 1) % 3] - part[k]));
      edge = std::max(edge, least);
      const double farther = std::max(end, edge), length = u.norm();
      for (std::size_t k = 0; k < 3; ++k) {
        const Point side = part[(k + 1) % 3] - part[k];
        const double along = std::abs(side.dot(u)) / length;
        const double across = std::sqrt(std::max(0.0, side.squaredNorm() - along * along));
        if (const double s = across / edge + along / farther; s > result.first) result = {s, k};
      }
    }
    return result;
  }

  void integrate(const Triangle& part, double share, int depth) const
  {
    const auto [steep, k] = steepness(part);
    std::size_t index = 0;
    while (index < triangle_rules && steep > steepest[index]) ++index;
    if (index == triangle_rules) {
      if (depth < deepest_graded) {
        Triangle first = part, second = part;
        first[(k + 1) % 3] = second[k] = (part[k] + part[(k + 1) % 3]) / 2;
        integrate(first, share / 2, depth + 1);
        integrate(second, share / 2, depth + 1);
        return;
      }
      --index;
    }
    const Point& n = panels.normal[outer];
    const std::array<Point, 3> slope{panels.gradient(outer, 0), panels.gradient(outer, 1), panels.gradient(outer, 2)};
    const auto& rule = triangle_rule(static_cast<int>(index));
    evaluations += rule.size();
    for (const auto& q : rule) {
      const Point x = q.at[0] * part[0] + q.at[1] * part[1] + q.at[2] * part[2];
      const auto of = layer_potentials(panels, inner, x);
      const double weight = q.weight * share;
      sum.single += weight * of.single;
      for (std::size_t c = 0; c < 6; ++c) sum.tensor[c] += weight * of.tensor[c];
      const double flux = -weight * n.dot(of.attraction);
      for (std::size_t c = 0; c < 3; ++c) {
        sum.double_y[c] += weight * of.double_layer[c];
        sum.double_x[c] += flux * (1 + slope[c].dot(x - panels.corner(outer, static_cast<int>(c))));
      }
    }
  }
};

PairIntegrals PairQuadrature::graded(std::size_t x, std::size_t y) const
{
  const bool turned = radius_[x] > radius_[y];
  const std::size_t outer = turned ? y : x, inner = turned ? x : y;
  std::array<Point, 3> corner{panels_.corner(outer, 0), panels_.corner(outer, 1), panels_.corner(outer, 2)};
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (corner[(k + 1) % 3] - corner[k]).norm());
  PairIntegrals sum;
  const Graded integral{panels_,   outer, inner,       accuracy_, least_part * accuracy_ * 2 * panels_.area[outer] / longest,
                        steepest_, sum,   evaluations_};
  integral.integrate(corner, 1, 0);
  if (turned) std::swap(sum.double_x, sum.double_y);
  return sum.times(panels_.area[outer] / (4 * std::numbers::pi));
}

}  // namespace mortise::bem
