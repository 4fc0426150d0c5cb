#include "integrals/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/dense.hpp"

namespace mortise::contact {

namespace {

// Gauss-Legendre points and weights on [0, 1].
struct Rule {
  std::vector<double> at, weight;
};

Rule gauss(int n)
{
  // Golub and Welsch: eigenvalues of the Jacobi matrix.
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n), next(std::max(n - 1, 1));
  for (int k = 1; k < n; ++k) next[k - 1] = k / std::sqrt(4.0 * k * k - 1);
  const auto eigen = dense::tridiagonal_eigenpairs(diagonal, next.head(n - 1));
  Rule rule;
  for (int k = 0; k < n; ++k) {
    rule.at.push_back(0.5 * (1 + eigen.values[k]));
    rule.weight.push_back(eigen.vectors(0, k) * eigen.vectors(0, k));
  }
  return rule;
}

constexpr std::size_t most_gauss_points = 9;

// A point of a rule for triangles by two of its barycentric coordinates; the weights sum to 1.
struct TrianglePoint {
  double first, second, weight;
};

// All places that differ by the order of the barycentric coordinates a, b, 1 - a - b.
void add_orbit(double a, double b, double weight, std::vector<TrianglePoint>& rule)
{
  const double c = 1 - a - b;
  for (const auto& [x, y] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) rule.push_back({x, y, weight});
  if (a == b) return;
  for (const auto& [x, y] : {std::pair(b, a), std::pair(c, b), std::pair(a, c)}) rule.push_back({x, y, weight});
}

std::vector<TrianglePoint> of_degree_4()
{
  std::vector<TrianglePoint> rule;
  add_orbit(0.44594849091596488632, 0.44594849091596488632, 0.22338158967801146570, rule);
  add_orbit(0.09157621350977074345, 0.09157621350977074345, 0.10995174365532186764, rule);
  return rule;
}

std::vector<TrianglePoint> of_degree_8()
{
  std::vector<TrianglePoint> rule{{1.0 / 3, 1.0 / 3, 0.144315607677787}};
  add_orbit(0.459292588292723, 0.459292588292723, 0.095091634267285, rule);
  add_orbit(0.170569307751760, 0.170569307751760, 0.103217370534718, rule);
  add_orbit(0.050547228317031, 0.050547228317031, 0.032458497623198, rule);
  add_orbit(0.263112829634638, 0.728492392955404, 0.027230314174435, rule);
  return rule;
}

// The fewest Gauss points that leave 1e-10 of products of shape functions of random quadrilaterals; nine of any.
std::size_t gauss_points(Integrand integrand)
{
  struct Enough {
    double variation;
    std::size_t first_order, second_order;
  };
  for (const auto& [variation, first_order, second_order] :
       {Enough{0.02, 4, 6}, Enough{0.1, 5, 6}, Enough{0.2, 6, 7}, Enough{0.3, 8, 8}})
    if (integrand.variation <= variation) return integrand.second_order ? second_order : first_order;
  return most_gauss_points;
}

void sample_rational(const Polygon& polygon, Integrand integrand, std::vector<Sample>& points)
{
  static const auto rules = [] {
    std::array<Rule, most_gauss_points + 1> all;
    for (std::size_t n = 1; n < all.size(); ++n) all[n] = gauss(static_cast<int>(n));
    return all;
  }();
  const Rule& rule = rules[gauss_points(integrand)];
  Plane centre = Plane::Zero();
  for (const auto& p : polygon) centre += p / static_cast<double>(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Plane a = polygon[i] - centre, b = polygon[(i + 1) % polygon.size()] - centre;
    const double twice = cross(a, b);
    if (!(twice > 0)) continue;
    for (std::size_t k = 0; k < rule.at.size(); ++k)  // the square collapsed to a triangle at the centre
      for (std::size_t l = 0; l < rule.at.size(); ++l)
        points.push_back(
            {centre + rule.at[k] * (a + rule.at[l] * (b - a)), twice * rule.at[k] * rule.weight[k] * rule.weight[l]});
  }
}

}  // namespace

double area_of(const Polygon& polygon)
{
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

Plane nearest_on(const Plane& a, const Plane& b, const Plane& x)
{
  const Plane edge = b - a;
  const double length = edge.squaredNorm();
  return length > 0 ? Plane(a + std::clamp((x - a).dot(edge) / length, 0.0, 1.0) * edge) : a;
}

Plane nearest_in(const Polygon& polygon, const Plane& x)
{
  if (polygon.size() == 2) return nearest_on(polygon[0], polygon[1], x);
  bool inside = true;
  Plane best = polygon[0];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Plane &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (cross(b - a, x - a) < 0) inside = false;
    const Plane on = nearest_on(a, b, x);
    if ((on - x).squaredNorm() < (best - x).squaredNorm()) best = on;
  }
  return inside ? x : best;
}

// Andrew's monotone chain.
std::vector<std::size_t> convex_hull(const std::vector<Plane>& points)
{
  std::vector<std::size_t> order(points.size()), chain;
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(points[a][0], points[a][1], a) < std::tie(points[b][0], points[b][1], b);
  });
  const auto grow = [&](auto begin, auto end) {
    const std::size_t first = chain.size();
    for (auto next = begin; next != end; ++next) {
      const auto left = [&](std::size_t a, std::size_t b) { return cross(points[b] - points[a], points[*next] - points[a]) > 0; };
      while (chain.size() >= first + 2 && !left(chain[chain.size() - 2], chain.back())) chain.pop_back();
      chain.push_back(*next);
    }
    chain.pop_back();  // where the other half begins
  };
  if (points.size() < 3) return order;
  grow(order.begin(), order.end());
  grow(order.rbegin(), order.rend());
  return chain;
}

void sample(const Polygon& polygon, Integrand integrand, std::vector<Sample>& points)
{
  static const auto low = of_degree_4(), high = of_degree_8();
  points.clear();
  if (integrand.variation > 0) return sample_rational(polygon, integrand, points);
  const auto& rule = integrand.second_order ? high : low;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Plane a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    const double area = 0.5 * cross(a, b);
    if (!(area > 0)) continue;
    for (const auto& point : rule) points.push_back({polygon[0] + point.first * a + point.second * b, area * point.weight});
  }
}

void sample(double begin, double end, std::vector<Sample>& points)
{
  static const Rule rule = gauss(3);
  points.clear();
  for (std::size_t k = 0; k < rule.at.size(); ++k)
    points.push_back({{begin + rule.at[k] * (end - begin), 0}, (end - begin) * rule.weight[k]});
}

}  // namespace mortise::contact
