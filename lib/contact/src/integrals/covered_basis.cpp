#include "integrals/covered_basis.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace mortise::contact {

namespace {

// Corners of the hull that cut off less than this part of it are none.
constexpr double blunt = 1e-3;
// Points nearer to others than this, in units of the covered part, add nothing.
constexpr double apart = 0.3;
// A function with less than this part of the integral of all is dropped: its point stands outside of what is covered.
constexpr double least_part = 1e-4;
// In units of the covered part: triangles of less area have no inside, and points are on a circle to this.
constexpr double flat_triangle = 1e-9, round = 1e-9;
constexpr double rounding_of_place = 1e-9;

double triangle(const Plane& a, const Plane& b, const Plane& c)
{
  return 0.5 * cross(b - a, c - a);
}

// Positive if d lies in the circle through a, b and c, which run counter-clockwise.
double in_circle(const Plane& a, const Plane& b, const Plane& c, const Plane& d)
{
  Eigen::Matrix3d m;
  int row = 0;
  for (const auto& p : {a, b, c}) m.row(row++) << (p - d)[0], (p - d)[1], (p - d).squaredNorm();
  return m.determinant();
}

// Which edges of a face its nodes lie on: bit e for the edge from corner e to the next.
unsigned edges_at_node(mesh::CellType type, std::size_t node)
{
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  if (node < corners) return 1U << node | 1U << (node + corners - 1) % corners;
  return node < 2 * corners ? 1U << (node - corners) : 0;
}

// And those that a place lies on.
unsigned edges_at(mesh::CellType type, std::span<const Plane> nodes, const Plane& x, double near)
{
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  unsigned result = 0;
  for (std::size_t e = 0; e < corners; ++e) {
    const Plane &a = nodes[e], &b = nodes[(e + 1) % corners], &middle = nodes.size() > corners ? nodes[corners + e] : b;
    if ((nearest_on(a, middle, x) - x).norm() < near || (nearest_on(middle, b, x) - x).norm() < near) result |= 1U << e;
  }
  return result;
}

}  // namespace

CoveredBasis::CoveredBasis(mesh::CellType type, std::span<const Plane> nodes, std::span<const CoveredPart> parts,
                           std::span<const Sample> samples, std::span<const BaseCorner> corners)
    : type_(type), nodes_(nodes)
{
  double largest = 0;
  for (const auto& part : parts) largest = std::max(largest, area_of(part.polygon));
  low_ = Plane::Constant(std::numeric_limits<double>::infinity());
  Plane high = -low_;
  for (const auto& part : parts) {
    if (area_of(part.polygon) < slit * largest) continue;
    parts_.push_back(part);
    for (const auto& p : part.polygon) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
  }
  extent_ = high - low_;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    length_ = std::max(length_, (nodes_[k] - nodes_[0]).norm());
    points_.push_back(nodes_[k]);
    facet_.push_back(-1);
  }
  take_nodes();
  add(corners);
  take_corners(corners);
  fill_up();
  do triangulate();
  while (!triangles_.empty() && drop_empty(samples));
  if (triangles_.empty()) take_one();
}

// Nodes that are covered keep their place.
void CoveredBasis::take_nodes()
{
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (const auto& part : parts_)
      if ((nearest_in(part.polygon, nodes_[k]) - nodes_[k]).norm() < rounding_of_place * length_) {
        facet_[k] = part.facet;
        break;
      }
}

void CoveredBasis::add(std::span<const BaseCorner> corners)
{
  for (const auto& corner : corners) {
    if (points_.size() == most_functions) return;
    points_.push_back(corner.at);
    facet_.push_back(corner.facet);
  }
}

// The corners of the convex hull, counter-clockwise.
std::vector<CoveredBasis::Corner> CoveredBasis::hull() const
{
  std::vector<Plane> at;
  std::vector<Local> facet;
  for (const auto& part : parts_)
    for (const auto& p : part.polygon) {
      at.push_back(p);
      facet.push_back(part.facet);
    }
  std::vector<Corner> corners;
  for (const std::size_t i : convex_hull(at)) {
    Corner corner{at[i], facet[i], false};
    for (std::size_t k = 0; k < size(); ++k)
      corner.node = corner.node || (has(k) && (at[i] - points_[k]).norm() < 1e-6 * length_);
    corners.push_back(corner);
  }
  return corners;
}

// The other corners of the hull, the sharpest of them, stand for nodes that are not covered. Of these a node on an edge that the
// covered part reaches also belongs to the next face, and only takes corners on that edge: elsewhere the two faces would mean
// different points.
void CoveredBasis::take_corners(std::span<const BaseCorner> base)
{
  auto corners = hull();
  const auto of_base = [&](const Corner& c) {
    return std::any_of(base.begin(), base.end(), [&](const BaseCorner& b) { return (b.at - c.at).norm() < 1e-6 * length_; });
  };
  const auto free_nodes = std::count_if(facet_.begin(), facet_.end(), [](Local facet) { return facet < 0; });
  double area = 0;
  for (const auto& c : corners)
    area += triangle(low_, c.at, corners[static_cast<std::size_t>(&c - corners.data() + 1) % corners.size()].at);
  for (;;) {
    const auto open = std::count_if(corners.begin(), corners.end(), [](const Corner& c) { return !c.node; });
    std::size_t least = corners.size();
    double cut_off = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto n = corners.size();
      const double size = triangle(corners[(i + n - 1) % n].at, corners[i].at, corners[(i + 1) % n].at);
      if (!corners[i].node && size < cut_off && (open <= free_nodes || !of_base(corners[i]))) cut_off = size, least = i;
    }
    if (least == corners.size() || (open <= free_nodes && cut_off > blunt * area)) break;
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(least));
  }
  std::erase_if(corners, [](const Corner& c) { return c.node; });

  unsigned reached = 0;
  for (const auto& part : parts_)
    for (const auto& p : part.polygon) reached |= edges_at(type_, nodes_, p, 1e-6 * length_);
  const auto cost = [&](const Corner& corner, std::size_t k) {
    const unsigned own = edges_at_node(type_, k), at = edges_at(type_, nodes_, corner.at, 1e-6 * length_);
    const double distance = (corner.at - nodes_[k]).squaredNorm() / (length_ * length_);
    return distance + (own & reached & ~at ? 100 : 0) + (at & ~own ? 10 : 0);
  };
  while (!corners.empty()) {
    std::size_t best = 0, node = nodes_.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t k = 0; k < nodes_.size(); ++k)
        if (const double c = has(k) ? std::numeric_limits<double>::infinity() : cost(corners[i], k); c < least)
          least = c, best = i, node = k;
    if (node == nodes_.size()) return;
    points_[node] = corners[best].at;
    facet_[node] = corners[best].facet;
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(best));
  }
}

// The nodes that are left stand for the next covered points.
void CoveredBasis::fill_up()
{
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (has(k)) continue;
    Plane best = Plane::Constant(std::numeric_limits<double>::infinity());
    Local facet = -1;
    for (const auto& part : parts_)
      if (const Plane at = nearest_in(part.polygon, nodes_[k]); !((at - nodes_[k]).norm() >= (best - nodes_[k]).norm()))
        best = at, facet = part.facet;
    bool far = true;
    for (std::size_t l = 0; l < size(); ++l) far = far && (!has(l) || (scaled(points_[l]) - scaled(best)).norm() > apart);
    if (far) points_[k] = best, facet_[k] = facet;
  }
}

// All triangles of points whose circles have no other point in them, in units of the covered part.
void CoveredBasis::triangulate()
{
  triangles_.clear();
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < size(); ++k)
    if (has(k)) used.push_back(k);
  std::vector<Plane> x;
  for (const std::size_t k : used) x.push_back(scaled(points_[k]));
  for (std::size_t i = 0; i < used.size(); ++i)
    for (std::size_t j = i + 1; j < used.size(); ++j)
      for (std::size_t k = j + 1; k < used.size(); ++k) {
        const double area = triangle(x[i], x[j], x[k]);
        if (std::abs(area) < flat_triangle) continue;
        const double sign = area > 0 ? 1 : -1;
        if (std::any_of(x.begin(), x.end(),
                        [&](const Plane& d) { return sign * in_circle(x[i], x[j], x[k], d) > round * std::abs(area); }))
          continue;
        Eigen::Matrix3d m;
        m << 1, 1, 1, x[i][0], x[j][0], x[k][0], x[i][1], x[j][1], x[k][1];
        triangles_.push_back({{used[i], used[j], used[k]}, m.inverse()});
      }
}

FaceShape CoveredBasis::operator()(const Plane& x) const
{
  FaceShape result = FaceShape::Zero(static_cast<Eigen::Index>(size()));
  if (triangles_.empty()) {
    for (std::size_t k = 0; k < size(); ++k)
      if (has(k)) result[static_cast<Eigen::Index>(k)] = 1;
    return result;
  }
  const Plane place = scaled(x);
  const Eigen::Vector3d at(1, place[0], place[1]);
  double least_outside = -std::numeric_limits<double>::infinity();
  for (const auto& t : triangles_) least_outside = std::max(least_outside, std::min((t.inverse * at).minCoeff(), 0.0));
  double count = 0;
  for (const auto& t : triangles_) {
    const Eigen::Vector3d values = t.inverse * at;
    if (values.minCoeff() < least_outside - rounding_of_place) continue;
    for (std::size_t i = 0; i < 3; ++i) result[static_cast<Eigen::Index>(t.nodes[i])] += values[static_cast<Eigen::Index>(i)];
    ++count;
  }
  return result / count;
}

// Too thin for linear functions: one that is constant, at the middle.
void CoveredBasis::take_one()
{
  Plane middle = Plane::Zero();
  double area = 0;
  for (const auto& part : parts_) {
    Plane centre = Plane::Zero();
    for (const auto& p : part.polygon) centre += p / static_cast<double>(part.polygon.size());
    middle += area_of(part.polygon) * centre;
    area += area_of(part.polygon);
  }
  middle /= area;
  Plane best = Plane::Constant(std::numeric_limits<double>::infinity());
  std::size_t node = 0;
  for (auto& facet : facet_) facet = -1;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if ((nodes_[k] - middle).norm() < (nodes_[node] - middle).norm()) node = k;
  }
  for (const auto& part : parts_)
    if (const Plane at = nearest_in(part.polygon, middle); !((at - middle).norm() >= (best - middle).norm()))
      best = at, facet_[node] = part.facet;
  points_[node] = best;
}

// Drops the function with the least integral if that is next to nothing; whether it did.
bool CoveredBasis::drop_empty(std::span<const Sample> samples)
{
  FaceShape sums = FaceShape::Zero(static_cast<Eigen::Index>(size()));
  for (const auto& sample : samples) sums += sample.weight * (*this)(sample.at);
  std::size_t least = size();
  for (std::size_t k = 0; k < size(); ++k)
    if (has(k) && (least == size() || sums[static_cast<Eigen::Index>(k)] < sums[static_cast<Eigen::Index>(least)])) least = k;
  if (sums[static_cast<Eigen::Index>(least)] > least_part * sums.sum()) return false;
  facet_[least] = -1;
  return true;
}

}  // namespace mortise::contact
