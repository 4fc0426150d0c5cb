// Integrals over two panels with common corners.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pair_integrals.hpp"
#include "rules.hpp"

namespace mortise::bem {

namespace {

constexpr int deepest = 16;             // halvings of a cube of coordinates
constexpr int fewest_in_corners = 3;    // points a coordinate of the integrals with common corners
constexpr double most_variation = 2.5;  // of the distance of two points in one part of those
// Parts of those, with a common corner, a common edge and of a panel with itself, up to which they are cheaper than closed forms.
constexpr std::array<std::size_t, 3> most_parts{60, 1000, 1000000};

using Weights = std::array<double, 3>;

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

}  // namespace

// In Sauter and Schwab's coordinates a corner of each panel is (0, 0), the common ones come first, then (1, 0), then (1, 1).
// Points of the two panels, for xi = 1, where a pair of panels has etas from number `free` on in which integrands are smooth
// functions. With xi and with the first of the other etas x - y only grows in proportion, and phi is linear, so that these
// integrals are known: kernels are evaluated where they are 1, phi of the double layers at means.
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
    std::size_t result = 1;
    for (std::size_t k = free; k < 3; ++k) result *= static_cast<std::size_t>(points);
    return result;
  }

  Region region(Map map, Etas e, double others) const
  {
    for (std::size_t k = 0; k < free; ++k) e[k] = others;
    return map(e);
  }

  double distance(Map map, const Etas& e) const
  {
    const Region r = region(map, e, 1);
    return (at(px, r.x) - at(py, r.y)).norm();
  }

  // Integral of xi phi over xi, a the place for xi = 1, over what xi and eta make of 1 / r.
  Weights means(const At& a, const std::array<int, 3>& order) const
  {
    const Weights values{0.5 + 1 - a.first, a.first - a.second, a.second};
    Weights result{};
    for (std::size_t k = 0; k < 3; ++k) result[static_cast<std::size_t>(order[k])] = values[k] / 3 / of_single();
    return result;
  }
  // Integral of xi^2, and of eta.
  double of_single() const { return free == 0 ? 1.0 / 3 : 1.0 / 6; }

  void put(const At& a, const At& b, const At& mean_a, const At& mean_b, double weight) const
  {
    add(at(px, a), at(py, b), nx, ny, 4 * of_single() * weight, means(mean_a, of_x), means(mean_b, of_y), sum);
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
    static const std::vector<Node> known{{1, 1}};
    const auto rule = [&](std::size_t k) -> const std::vector<Node>& { return k < free ? known : gauss(points); };
    const auto &first = rule(0), &second = rule(1), &third = rule(2);
    for (const auto& [s, w0] : first)
      for (const auto& [t, w1] : second)
        for (const auto& [u, w2] : third) {
          const Etas e{low[0] + s * size[0], low[1] + t * size[1], low[2] + u * size[2]};
          const Region r = map(e), mean = region(map, e, 0.5);
          const double weight = w0 * w1 * w2 * size[0] * size[1] * size[2] * r.weight;
          put(r.x, r.y, mean.x, mean.y, weight);
          if (mirrored) put(r.y, r.x, mean.y, mean.x, weight);
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
