#include "pair_integrals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rules.hpp"

namespace mortise::bem {

namespace {

constexpr int far_rules = 4;            // the symmetric rules, for pairs of whole panels
constexpr int deepest = 16;             // halvings of a cube of coordinates
constexpr std::size_t lanes = 8;        // pairs that are integrated side by side
constexpr int fewest_in_corners = 3;    // points a coordinate of the integrals with common corners
constexpr double most_variation = 2.5;  // of the distance of two points in one part of those
// Parts of those, with a common corner, a common edge and of a panel with itself, up to which they are cheaper than closed forms.
constexpr std::array<std::size_t, 3> most_parts{60, 1000, 1000000};

// A triangle by its corners, and these by the area coordinates of the panel that it is a part of.
struct Part {
  std::array<Point, 3> corner;
  std::array<std::array<double, 3>, 3> at;
  Point centre;
  double radius, area;
};

using Weights = std::array<double, 3>;

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

// Adds what one pair of points gives.
void add(const Point& x, const Point& y, const Point& nx, const Point& ny, double weight, const Weights& at_x,
         const Weights& at_y, PairIntegrals& sum)
{
  const Point d = x - y;
  const double inverse = 1 / d.norm(), g = weight * inverse, g3 = g * inverse * inverse;
  sum.single += g;
  sum.tensor[0] += g3 * d[0] * d[0];
  sum.tensor[1] += g3 * d[1] * d[1];
  sum.tensor[2] += g3 * d[2] * d[2];
  sum.tensor[3] += g3 * d[0] * d[1];
  sum.tensor[4] += g3 * d[1] * d[2];
  sum.tensor[5] += g3 * d[0] * d[2];
  const double to_y = g3 * ny.dot(d), to_x = -g3 * nx.dot(d);
  for (std::size_t k = 0; k < 3; ++k) {
    sum.double_y[k] += to_y * at_y[k];
    sum.double_x[k] += to_x * at_x[k];
  }
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

// In Sauter and Schwab's coordinates a corner of each panel is (0, 0), the common ones come first, then (1, 0), then (1, 1).
// Points of the two panels, for xi = 1, where a pair of panels has `free` coordinates eta in which integrands are smooth
// functions; in xi, and in the etas before the free ones, they are polynomials for which two points are exact.
struct PairQuadrature::Touching {
  struct At {
    double first, second;
  };
  struct Region {
    At x, y;
    double weight;  // but for xi^3 and the powers of the etas that are not free
  };
  using Etas = std::array<double, 3>;
  using Map = Region (*)(const Etas&);

  static Region swapped(const Region& r) { return {r.y, r.x, r.weight}; }
  // Of a panel with itself: with each region also its mirror image.
  static Region same_1(const Etas& e)
  {
    return {{1, 1 - e[0] + e[0] * e[1]}, {1 - e[0] * e[1] * e[2], 1 - e[0]}, e[0] * e[0] * e[1]};
  }
  static Region same_2(const Etas& e)
  {
    return {{1, e[0] * (1 - e[1] + e[1] * e[2])}, {1 - e[0] * e[1], e[0] * (1 - e[1])}, e[0] * e[0] * e[1]};
  }
  static Region same_3(const Etas& e)
  {
    return {{1 - e[0] * e[1] * e[2], e[0] * (1 - e[1] * e[2])}, {1, e[0] * (1 - e[1])}, e[0] * e[0] * e[1]};
  }
  static Region edge_1(const Etas& e) { return {{1, e[0] * e[2]}, {1 - e[0] * e[1], e[0] * (1 - e[1])}, e[0] * e[0]}; }
  static Region edge_2(const Etas& e)
  {
    return {{1, e[0]}, {1 - e[0] * e[1] * e[2], e[0] * e[1] * (1 - e[2])}, e[0] * e[0] * e[1]};
  }
  static Region edge_3(const Etas& e)
  {
    return {{1 - e[0] * e[1], e[0] * (1 - e[1])}, {1, e[0] * e[1] * e[2]}, e[0] * e[0] * e[1]};
  }
  static Region edge_4(const Etas& e) { return swapped(edge_2(e)); }
  static Region edge_5(const Etas& e)
  {
    return {{1 - e[0] * e[1] * e[2], e[0] * (1 - e[1] * e[2])}, {1, e[0] * e[1]}, e[0] * e[0] * e[1]};
  }
  static Region corner_1(const Etas& e) { return {{1, e[0]}, {e[1], e[1] * e[2]}, e[1]}; }
  static Region corner_2(const Etas& e) { return swapped(corner_1(e)); }

  std::array<Point, 3> px, py;
  std::array<int, 3> of_x, of_y;
  Point nx, ny;
  std::size_t free;  // the first free eta
  int points;        // a coordinate
  bool mirrored;
  PairIntegrals& sum;

  static Point at(const std::array<Point, 3>& p, const At& a)
  {
    return (1 - a.first) * p[0] + (a.first - a.second) * p[1] + a.second * p[2];
  }

  std::size_t points_of_a_part() const
  {
    std::size_t result = 2;
    for (std::size_t k = 0; k < 3; ++k) result *= k < free ? 2 : static_cast<std::size_t>(points);
    return result;
  }

  double distance(Map map, Etas e) const
  {
    for (std::size_t k = 0; k < free; ++k) e[k] = 1;
    const Region r = map(e);
    return (at(px, r.x) - at(py, r.y)).norm();
  }

  void put(const At& a, const At& b, double weight) const
  {
    const Weights wx{1 - a.first, a.first - a.second, a.second}, wy{1 - b.first, b.first - b.second, b.second};
    Weights at_x{}, at_y{};
    for (std::size_t k = 0; k < 3; ++k) {
      at_x[static_cast<std::size_t>(of_x[k])] = wx[k];
      at_y[static_cast<std::size_t>(of_y[k])] = wy[k];
    }
    add(at(px, a), at(py, b), nx, ny, 4 * weight, at_x, at_y, sum);
  }

  // Over the free etas from low to low + size: the one along which the distance of the points varies most, or `none` if it varies
  // by little. It varies by much where panels are slender.
  static constexpr std::size_t none = 3;
  std::size_t to_halve(Map map, const Etas& low, const Etas& size) const
  {
    Etas middle{};
    for (std::size_t k = 0; k < 3; ++k) middle[k] = low[k] + size[k] / 2;
    const double centre = distance(map, middle);
    double least = centre, most = centre, steepest = -1;
    std::size_t along = free;
    for (std::size_t k = free; k < 3; ++k) {
      Etas e = middle;
      e[k] = low[k];
      const double before = distance(map, e);
      e[k] = low[k] + size[k];
      const double after = distance(map, e);
      least = std::min({least, before, after});
      most = std::max({most, before, after});
      const double varies = std::max({before, after, centre}) / std::min({before, after, centre});
      if (varies > steepest) {
        steepest = varies;
        along = k;
      }
    }
    for (int corner = 0; corner < 8; ++corner) {
      Etas e = low;
      for (std::size_t k = free; k < 3; ++k)
        if ((corner >> k & 1) != 0) e[k] += size[k];
      const double d = distance(map, e);
      least = std::min(least, d);
      most = std::max(most, d);
    }
    return most > most_variation * least ? along : none;
  }

  struct Box {
    Map map;
    Etas low, size;
  };

  // Appends the parts into which the etas are cut; false if there are more than `limit` of them, or too small ones.
  bool cut(const Box& box, int depth, std::size_t limit, std::vector<Box>& parts) const
  {
    const std::size_t along = to_halve(box.map, box.low, box.size);
    if (along == none) {
      parts.push_back(box);
      return parts.size() <= limit;
    }
    if (depth == deepest) return false;
    Box first = box;
    first.size[along] /= 2;
    Box second = first;
    second.low[along] += first.size[along];
    return cut(first, depth + 1, limit, parts) && cut(second, depth + 1, limit, parts);
  }

  void integrate(const Box& box) const
  {
    const auto& [map, low, size] = box;
    const auto &fine = gauss(points), &exact = gauss(2);
    const auto rule = [&](std::size_t k) -> const std::vector<Node>& { return k < free ? exact : fine; };
    for (const auto& [s, w0] : rule(0))
      for (const auto& [t, w1] : rule(1))
        for (const auto& [u, w2] : rule(2)) {
          const Region r = map({low[0] + s * size[0], low[1] + t * size[1], low[2] + u * size[2]});
          for (const auto& [xi, w3] : exact) {
            const double weight = w0 * w1 * w2 * w3 * size[0] * size[1] * size[2] * xi * xi * xi * r.weight;
            const At a{xi * r.x.first, xi * r.x.second}, b{xi * r.y.first, xi * r.y.second};
            put(a, b, weight);
            if (mirrored) put(b, a, weight);
          }
        }
  }
};

PairIntegrals PairQuadrature::touching(std::size_t x, std::size_t y, const std::array<int, 3>& of_x,
                                       const std::array<int, 3>& of_y, int common) const
{
  PairIntegrals sum;
  std::array<Point, 3> px, py;
  for (std::size_t k = 0; k < 3; ++k) {
    px[k] = panels_.corner(x, of_x[k]);
    py[k] = panels_.corner(y, of_y[k]);
  }
  const auto free = static_cast<std::size_t>(common - 1);
  const int points = std::max(fewest_in_corners, static_cast<int>(std::ceil(0.8 - std::log10(accuracy_))));
  const Touching touching{px, py, of_x, of_y, panels_.normal[x], panels_.normal[y], free, points, common == 3, sum};
  using T = Touching;
  static const std::array<std::vector<T::Map>, 3> maps{
      {{T::corner_1, T::corner_2}, {T::edge_1, T::edge_2, T::edge_3, T::edge_4, T::edge_5}, {T::same_1, T::same_2, T::same_3}}};
  std::vector<T::Box> parts;
  for (const auto map : maps[free])
    if (!touching.cut({map, {0, 0, 0}, {1, 1, 1}}, 0, most_parts[free], parts)) return graded(x, y);
  evaluations_ += parts.size() * touching.points_of_a_part();
  for (const auto& part : parts) touching.integrate(part);
  if (common == 3) sum.double_x = sum.double_y = {};  // d lies in the plane
  return sum.times(panels_.area[x] * panels_.area[y] / (4 * std::numbers::pi));
}

}  // namespace mortise::bem
