#include "pair_integrals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rules.hpp"

namespace mortise::bem {

namespace {

constexpr int far_rules = 4;      // the symmetric rules, for pairs of whole panels
constexpr std::size_t lanes = 8;  // pairs that are integrated side by side

// A triangle by its corners, and these by the area coordinates of the panel that it is a part of.
struct Part {
  std::array<Point, 3> corner;
  std::array<std::array<double, 3>, 3> at;
  Point centre;
  double radius, area;
};

Part make_part(const std::array<Point, 3>& corner, const std::array<std::array<double, 3>, 3>& at, double area)
{
  Part part{corner, at, (corner[0] + corner[1] + corner[2]) / 3, 0, area};
  for (const auto& p : corner) part.radius = std::max(part.radius, (p - part.centre).norm());
  return part;
}

Part whole(const Panels& panels, std::size_t p)
{
  return make_part({panels.corner(p, 0), panels.corner(p, 1), panels.corner(p, 2)}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                   panels.area[p]);
}

// Errors of the rules, relative to those of the nearest pairs, for panels whose sizes are t times the distance of their centres:
// below factor * t^power for t < 1 (measured on triangles of all directions).
struct RuleError {
  double factor;
  int power;
};
constexpr std::array<RuleError, triangle_rules> pair_rule_errors{
    {{5e-3, 3}, {5e-4, 5}, {2e-5, 7}, {1e-5, 9}, {3e-7, 11}, {5e-8, 13}, {1e-8, 15}}};

// The largest t for which each rule is as good as `accuracy`.
std::array<double, triangle_rules> largest_ratios(double accuracy)
{
  std::array<double, triangle_rules> result;
  for (std::size_t r = 0; r < result.size(); ++r)
    result[r] = std::min(1.0, std::pow(accuracy / pair_rule_errors[r].factor, 1.0 / pair_rule_errors[r].power));
  return result;
}

constexpr std::array<int, triangle_rules> rule_degrees{2, 4, 6, 8, 10, 12, 14};

// The largest steepness for which each rule is as good as `accuracy`: with a singularity at a distance of 1 / steepness from an
// interval of length 1, errors fall with the degree as rho^-degree, rho = 1 + 2 z + 2 sqrt(z + z^2), z = 1 / steepness.
std::array<double, triangle_rules> largest_steepness(double accuracy)
{
  std::array<double, triangle_rules> result;
  for (std::size_t r = 0; r < result.size(); ++r) {
    const double rho = std::pow(1 / accuracy, 1.0 / rule_degrees[r]);
    result[r] = 4 * rho / ((rho - 1) * (rho - 1));
  }
  return result;
}

}  // namespace

PairIntegrals PairIntegrals::times(double factor) const
{
  PairIntegrals result = *this;
  result.single *= factor;
  for (auto& v : result.tensor) v *= factor;
  for (auto& v : result.double_x) v *= factor;
  for (auto& v : result.double_y) v *= factor;
  return result;
}

PairQuadrature::PairQuadrature(const Panels& panels, double accuracy)
    : panels_(panels), accuracy_(accuracy), largest_(largest_ratios(accuracy)), steepest_(largest_steepness(accuracy))
{
  const auto size = panels.corners.size();
  for (std::size_t p = 0; p < size; ++p) {
    const Part part = whole(panels, p);
    centre_.push_back(part.centre);
    radius_.push_back(part.radius);
  }
  for (int r = 0; r < far_rules; ++r) {
    const auto& rule = triangle_rule(r);
    auto& points = points_.emplace_back(3 * rule.size() * size);
    for (std::size_t p = 0; p < size; ++p)
      for (std::size_t q = 0; q < rule.size(); ++q) {
        Point x = Point::Zero();
        for (int k = 0; k < 3; ++k) x += rule[q].at[static_cast<std::size_t>(k)] * panels.corner(p, k);
        for (std::size_t c = 0; c < 3; ++c) points[(3 * q + c) * size + p] = x[static_cast<int>(c)];
      }
  }
}

// Several pairs (x, y) side by side, all with one rule.
struct PairQuadrature::Far {
  using Lane = std::array<double, lanes>;

  static void integrate(const PairQuadrature& all, std::size_t x, std::span<const std::size_t> others, int index,
                        PairIntegrals* const* results)
  {
    const Panels& panels = all.panels_;
    const auto& rule = triangle_rule(index);
    const auto& points = all.points_[static_cast<std::size_t>(index)];
    const std::size_t size = panels.corners.size();
    Lane n0{}, n1{}, n2{}, offset{};
    std::array<std::array<Lane, 3>, 16> y;
    for (std::size_t l = 0; l < lanes; ++l) {
      const std::size_t p = others[std::min(l, others.size() - 1)];
      const Point& n = panels.normal[p];
      n0[l] = n[0];
      n1[l] = n[1];
      n2[l] = n[2];
      offset[l] = n.dot(all.centre_[p]);
      for (std::size_t q = 0; q < rule.size(); ++q)
        for (std::size_t c = 0; c < 3; ++c) y[q][c][l] = points[(3 * q + c) * size + p];
    }
    const Point& nx = panels.normal[x];
    const double offset_x = nx.dot(all.centre_[x]);
    Lane single{};
    std::array<Lane, 6> tensor{};
    std::array<Lane, 3> double_x{}, double_y{};
    for (std::size_t a = 0; a < rule.size(); ++a) {
      const double x0 = points[3 * a * size + x], x1 = points[(3 * a + 1) * size + x], x2 = points[(3 * a + 2) * size + x];
      Lane height, from_x{};
      for (std::size_t l = 0; l < lanes; ++l) height[l] = n0[l] * x0 + n1[l] * x1 + n2[l] * x2 - offset[l];
      for (std::size_t b = 0; b < rule.size(); ++b) {
        const double w = rule[a].weight * rule[b].weight;
        const auto& [y0, y1, y2] = y[b];
        const auto [p0, p1, p2] = rule[b].at;
        for (std::size_t l = 0; l < lanes; ++l) {
          const double d0 = x0 - y0[l], d1 = x1 - y1[l], d2 = x2 - y2[l];
          const double inverse = 1 / std::sqrt(d0 * d0 + d1 * d1 + d2 * d2), g = w * inverse, g3 = g * inverse * inverse;
          single[l] += g;
          const double e0 = g3 * d0, e1 = g3 * d1;
          tensor[0][l] += e0 * d0;
          tensor[1][l] += e1 * d1;
          tensor[2][l] += g3 * d2 * d2;
          tensor[3][l] += e0 * d1;
          tensor[4][l] += e1 * d2;
          tensor[5][l] += e0 * d2;
          const double to_y = g3 * height[l];
          double_y[0][l] += to_y * p0;
          double_y[1][l] += to_y * p1;
          double_y[2][l] += to_y * p2;
          from_x[l] += g3 * (nx[0] * y0[l] + nx[1] * y1[l] + nx[2] * y2[l] - offset_x);
        }
      }
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = 0; l < lanes; ++l) double_x[k][l] += from_x[l] * rule[a].at[k];
    }
    for (std::size_t l = 0; l < others.size(); ++l) {
      PairIntegrals sum{single[l], {}, {}, {}};
      for (std::size_t k = 0; k < 6; ++k) sum.tensor[k] = tensor[k][l];
      for (std::size_t k = 0; k < 3; ++k) {
        sum.double_x[k] = double_x[k][l];
        sum.double_y[k] = double_y[k][l];
      }
      *results[l] = sum.times(panels.area[x] * panels.area[others[l]] / (4 * std::numbers::pi));
    }
  }
};

void PairQuadrature::integrate(std::size_t x, std::span<const std::size_t> others, std::span<PairIntegrals> results) const
{
  std::array<std::vector<std::size_t>, far_rules> panels;
  std::array<std::vector<PairIntegrals*>, far_rules> places;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const std::size_t y = others[i];
    const double size = radius_[x] + radius_[y], ratio = size / (centre_[x] - centre_[y]).norm();
    std::size_t rule = 0;
    while (rule < far_rules && !(ratio < largest_[rule])) ++rule;
    if (rule == far_rules) {
      results[i] = close(x, y);
      continue;
    }
    panels[rule].push_back(y);
    places[rule].push_back(&results[i]);
    if (panels[rule].size() == lanes) {
      Far::integrate(*this, x, panels[rule], static_cast<int>(rule), places[rule].data());
      panels[rule].clear();
      places[rule].clear();
    }
  }
  for (std::size_t r = 0; r < far_rules; ++r)
    if (!panels[r].empty()) Far::integrate(*this, x, panels[r], static_cast<int>(r), places[r].data());
}

PairIntegrals PairQuadrature::close(std::size_t x, std::size_t y) const
{
  // Common corners first, the others after them.
  std::array<int, 3> of_x{}, of_y{};
  int common = 0;
  const auto &cx = panels_.corners[x], &cy = panels_.corners[y];
  std::array<bool, 3> used_x{}, used_y{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (cx[i] == cy[j]) {
        of_x[static_cast<std::size_t>(common)] = static_cast<int>(i);
        of_y[static_cast<std::size_t>(common++)] = static_cast<int>(j);
        used_x[i] = used_y[j] = true;
      }
  for (std::size_t i = 0, at_x = static_cast<std::size_t>(common), at_y = at_x; i < 3; ++i) {
    if (!used_x[i]) of_x[at_x++] = static_cast<int>(i);
    if (!used_y[i]) of_y[at_y++] = static_cast<int>(i);
  }
  if (common > 0) return touching(x, y, of_x, of_y, common);

  return graded(x, y);
}

}  // namespace mortise::bem
