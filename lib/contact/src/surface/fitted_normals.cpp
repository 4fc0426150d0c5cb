#include "surface/fitted_normals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "base/dense.hpp"

namespace mortise::contact {

namespace {

// Nodes round one that determine a surface of second order, with one to spare.
constexpr std::size_t enough = 6;
// Heights below this part of the distances are rounding.
constexpr double plane_surface = 1e-10;
// How far what the nodes do not determine is held: a slope where it is, a curvature at 0. What they determine is found all the
// same, step by step. Both are the same in all directions: nothing that is found along one leaks into another that is not
// determined.
constexpr double held_slope = 0.01, held_curvature = 1e-6;
constexpr int steps = 8;
constexpr double settled = 1e-13;
// What a surface of second order may leave of the heights: more is an edge, or scatter.
constexpr double most_left = 0.2;

// Where it leaves more than that of the nodes round these, too, it may be two surfaces, and is if they leave as little as this,
// and so much less: in the line in which a cylinder runs into a fillet 0.01 to 0.04, in a row of nodes beside it 0.12 to 0.16.
constexpr double of_two = 0.05, explained = 0.2;
// Cosine: lines from node to node go on as straight as this.
constexpr double straight = -0.9;
constexpr std::size_t enough_for_two = 9;

// The surface nodes that share a facet with each, ascending.
class Neighbours {
 public:
  Neighbours(const Side& side, const SurfaceNodes& surface_nodes) : offset_(surface_nodes.all.size() + 1, 0)
  {
    std::vector<std::pair<Local, Local>> pairs;
    for (std::size_t f = 0; f < side.facets.size(); ++f) {
      const auto begin = static_cast<std::size_t>(side.facets.offset[f]), n = side.facets[f].size();
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          if (a != b) pairs.emplace_back(surface_nodes.of_corner[begin + a], surface_nodes.of_corner[begin + b]);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [from, to] : pairs) {
      ++offset_[static_cast<std::size_t>(from) + 1];
      to_.push_back(to);
    }
    for (std::size_t p = 0; p + 1 < offset_.size(); ++p) offset_[p + 1] += offset_[p];
  }

  std::span<const Local> operator[](std::size_t p) const { return {to_.data() + offset_[p], offset_[p + 1] - offset_[p]}; }

  // Those round a surface node, and if `farther` those round these.
  void round(std::size_t p, bool farther, std::vector<Local>& result) const
  {
    result.assign((*this)[p].begin(), (*this)[p].end());
    if (!farther) return;
    std::vector<Local> next;
    for (const Local q : (*this)[p])
      for (const Local r : (*this)[static_cast<std::size_t>(q)])
        if (r != static_cast<Local>(p) && !std::binary_search((*this)[p].begin(), (*this)[p].end(), r)) next.push_back(r);
    std::sort(next.begin(), next.end());
    result.insert(result.end(), next.begin(), std::unique(next.begin(), next.end()));
  }

 private:
  std::vector<std::size_t> offset_;
  std::vector<Local> to_;
};

// The tangents along which the distances are longest and shortest: nodes may lie far closer one way than the other.
std::pair<Point, Point> principal_tangents(const std::vector<Point>& d, const Point& normal)
{
  const Point any = normal.unitOrthogonal(), other = normal.cross(any);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& v : d) {
    const Eigen::Vector2d at(v.dot(any), v.dot(other));
    spread += at * at.transpose() / v.squaredNorm();
  }
  const Eigen::Vector2d axis = dense::plane_eigenpairs(spread).vectors.col(1);
  return {axis[0] * any + axis[1] * other, axis[0] * other - axis[1] * any};
}

// Along a line and across.
std::pair<Point, Point> tangents_of_line(const Point& line, const Point& normal)
{
  const Point along = (line - line.dot(normal) * normal).normalized();
  return {along, normal.cross(along)};
}

// A surface of second order through the origin.
struct Fitted {
  Point normal;
  double left;  // of the heights of the points
  Point s, t;   // 2 z = across s^2 + 2 twist s t + along t^2 + curvature z^2
  double across, twist, along, curvature;

  // The same of other points.
  double left_of(std::span<const Point> points) const
  {
    double sum = 0, all = 0;
    for (const Point& v : points) {
      const double x = v.dot(s), y = v.dot(t), z = v.dot(normal), weight = 1 / std::pow(v.squaredNorm(), 2);
      sum += weight * std::pow(z - (across * x * x + 2 * twist * x * y + along * y * y + curvature * z * z) / 2, 2);
      all += weight * z * z;
    }
    return all > 0 ? std::sqrt(sum / all) : 0;
  }
};

// The one next to points d, with a normal next to `start`; `start` and all of the heights if there is none. With a `line`: two
// surfaces which meet in it and have one tangent plane there, with curvatures across that differ.
Fitted fitted(const std::vector<Point>& d, const Point& start, const Point* line = nullptr)
{
  const auto count = static_cast<Eigen::Index>(d.size());
  const Fitted none{start, 1, Point::Zero(), Point::Zero(), 0, 0, 0, 0};
  double length = 0, height = 0;
  for (const auto& v : d) {
    length = std::max(length, v.norm());
    height = std::max(height, std::abs(v.dot(start)) / v.norm());
  }
  const Eigen::Index columns = line ? 6 : 5;
  Eigen::MatrixXd rows(count + columns, columns);
  Eigen::VectorXd heights(count + columns);
  Fitted result = none;
  Point& normal = result.normal;
  std::array<double, 2> curvature{0, 0};  // the larger one, on each side of the line
  for (int step = 0; step < steps; ++step) {
    const auto [s, t] = line ? tangents_of_line(*line, normal) : principal_tangents(d, normal);
    rows.setZero();
    heights.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const Point& v = d[static_cast<std::size_t>(i)];
      const double x = v.dot(s), y = v.dot(t), z = v.dot(normal), square = v.squaredNorm();
      const int beyond = line && y > 0 ? 1 : 0;
      rows.row(i).head(4) << x * length, y * length, x * x / 2, x * y;
      rows(i, 4 + beyond) = y * y / 2;
      rows.row(i) /= square;
      heights[i] = (z - curvature[static_cast<std::size_t>(beyond)] * z * z / 2) / square;
    }
    Eigen::VectorXd scale(columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
      scale[c] = std::max(rows.col(c).norm(), 1e-30 / length);
      rows.col(c) /= scale[c];
      rows(count + c, c) = (c < 2 ? held_slope : c == 3 ? std::sqrt(2.0) * held_curvature : held_curvature) / scale[c];
    }
    const Eigen::VectorXd found = dense::least_squares(rows, heights);
    const Eigen::VectorXd left = rows.topRows(count) * found - heights.head(count);
    result.left = left.norm() / std::max(heights.head(count).norm(), std::numeric_limits<double>::min());
    if (!(result.left <= most_left)) return none;
    const Eigen::VectorXd c = found.cwiseQuotient(scale);
    const Eigen::Vector2d slope(c[0] * length, c[1] * length);
    for (Eigen::Index beyond = 0; beyond + 4 < columns; ++beyond) {
      const double mean = (c[2] + c[4 + beyond]) / 2, spread = std::hypot((c[2] - c[4 + beyond]) / 2, c[3]);
      curvature[static_cast<std::size_t>(beyond)] = mean > 0 ? mean + spread : mean - spread;
    }
    result.s = s, result.t = t;
    result.across = c[2], result.twist = c[3], result.along = c[4], result.curvature = curvature[0];
    normal = (normal - slope[0] * s - slope[1] * t).normalized();
    if (slope.norm() > 2 * height) return none;
    if (slope.norm() < settled) break;
  }
  return (normal - start).norm() > height ? none : result;
}

// Two surfaces that meet in a line through a surface node.
struct TwoSurfaces {
  std::size_t at;
  Few<Local, 2> ends;  // the next surface nodes of the line
  Point normal;

  bool leads_to(std::size_t p) const { return std::find(ends.begin(), ends.end(), static_cast<Local>(p)) != ends.end(); }
};

class Fits {
 public:
  Fits(const Side& side, const SurfaceNodes& surface_nodes)
      : side_(side), surface_nodes_(surface_nodes), neighbours_(side, surface_nodes)
  {
  }

  // The normal of the surface through the nodes round one, from `start`; where they lie in its plane, that of the `mean`.
  Point normal(std::size_t p, bool border, const Point& mean, const Point& start)
  {
    gather(p, border || neighbours_[p].size() < enough);
    if (d_.empty()) return start;
    if (std::all_of(d_.begin(), d_.end(), [&](const Point& v) { return std::abs(v.dot(mean)) < plane_surface * v.norm(); }))
      return mean;
    const Fitted one = fitted(d_, start);
    gather(p, true);
    if (one.left == 1 || one.left_of(d_) > most_left) attempt_two(p, border, start);
    return one.normal;
  }

  // Those that explain the nodes, where the next node of the line says the same: by chance a single node may look like it.
  std::vector<TwoSurfaces> two_surfaces() const
  {
    const auto says = [&](Local end, std::size_t p) {
      const auto other = std::ranges::lower_bound(two_, static_cast<std::size_t>(end), {}, &TwoSurfaces::at);
      return other != two_.end() && other->at == static_cast<std::size_t>(end) && other->leads_to(p);
    };
    std::vector<TwoSurfaces> result;
    std::ranges::copy_if(two_, std::back_inserter(result), [&](const TwoSurfaces& two) {
      return std::any_of(two.ends.begin(), two.ends.end(), [&](Local end) { return says(end, two.at); });
    });
    return result;
  }

 private:
  // The nodes round a surface node, and if `farther` those round these: the first `near_` are the nodes next to it.
  void gather(std::size_t p, bool farther)
  {
    const auto at = [&](std::size_t q) -> const Point& {
      return side_.points[static_cast<std::size_t>(surface_nodes_.all[q].node)];
    };
    neighbours_.round(p, farther, round_);
    std::erase_if(round_, [&](Local q) { return at(static_cast<std::size_t>(q)) == at(p); });
    near_ = static_cast<std::size_t>(
        std::ranges::count_if(round_, [&](Local q) { return std::ranges::binary_search(neighbours_[p], q); }));
    d_.clear();
    for (const Local q : round_) d_.push_back(at(static_cast<std::size_t>(q)) - at(p));
  }

  // In one of the lines from node to node, or at a border, where lines may end, in one from it.
  void attempt_two(std::size_t p, bool border, const Point& start)
  {
    if (d_.size() < enough_for_two) return;
    TwoSurfaces best{p, {}, start};
    double least = std::min(explained * fitted(d_, start).left, of_two);
    const auto attempt = [&](const Point& line, const Few<Local, 2>& ends) {
      if (const Fitted two = fitted(d_, start, &line); two.left < least) {
        least = two.left;
        best.ends = ends;
        best.normal = two.normal;
      }
    };
    for (std::size_t a = 0; a < near_; ++a) {
      if (border) attempt(d_[a], {round_[a]});
      for (std::size_t b = 0; b < a; ++b)
        if (d_[a].dot(d_[b]) < straight * d_[a].norm() * d_[b].norm())
          attempt((d_[a].normalized() - d_[b].normalized()).normalized(), {round_[a], round_[b]});
    }
    if (best.ends.size() > 0) two_.push_back(best);
  }

  const Side& side_;
  const SurfaceNodes& surface_nodes_;
  const Neighbours neighbours_;
  std::vector<Local> round_;
  std::vector<Point> d_;
  std::size_t near_ = 0;
  std::vector<TwoSurfaces> two_;  // ascending
};

}  // namespace

void fit_normals(const Side& side, const SurfaceNodes& means, const std::vector<bool>& border, SurfaceNodes& surface_nodes)
{
  Fits fits(side, surface_nodes);
  for (std::size_t p = 0; p < surface_nodes.all.size(); ++p) {
    auto& normal = surface_nodes.all[p].normal;
    normal = fits.normal(p, border[p], means.all[p].normal, normal);
  }
  for (const auto& two : fits.two_surfaces()) surface_nodes.all[two.at].normal = two.normal;
}

}  // namespace mortise::contact
