#include "overlap.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace mortise::contact {

using mesh::CellType;

namespace {

constexpr double negligible = 1e-10;  // part of the face's area below which an overlap is rounding

Frame frame_of(const FaceGeometry& face)
{
  Frame frame{face.centre(), (face.nodes[1] - face.nodes[0]).normalized(), Point::Zero(), face.normal()};
  frame.first = (frame.first - frame.first.dot(frame.normal) * frame.normal).normalized();
  if (face.type != CellType::line2) frame.second = frame.normal.cross(frame.first);
  return frame;
}

double cross(const Plane& a, const Plane& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

double area_of(const std::vector<Plane>& polygon)
{
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

// Part of `subject` inside the convex, counter-clockwise `clip` [Sutherland and Hodgman].
std::vector<Plane> clip_polygon(std::vector<Plane> subject, const std::vector<Plane>& clip)
{
  for (std::size_t e = 0; e < clip.size() && !subject.empty(); ++e) {
    const Plane a = clip[e], edge = clip[(e + 1) % clip.size()] - a;
    std::vector<Plane> kept;
    for (std::size_t i = 0; i < subject.size(); ++i) {
      const Plane &p = subject[i], &q = subject[(i + 1) % subject.size()];
      const double dp = cross(edge, p - a), dq = cross(edge, q - a);
      if (dp >= 0) kept.push_back(p);
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
    }
    subject = std::move(kept);
  }
  return subject;
}

// Gauss-Legendre points and weights on [0, 1].
struct Rule {
  std::vector<double> at, weight;
};

Rule gauss(int n)
{
  // Golub and Welsch: eigenvalues of the Jacobi matrix.
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n), next(std::max(n - 1, 1));
  for (int k = 1; k < n; ++k) next[k - 1] = k / std::sqrt(4.0 * k * k - 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal, next.head(n - 1));
  Rule rule;
  for (int k = 0; k < n; ++k) {
    rule.at.push_back(0.5 * (1 + eigen.eigenvalues()[k]));
    rule.weight.push_back(eigen.eigenvectors()(0, k) * eigen.eigenvectors()(0, k));
  }
  return rule;
}

bool parallelogram(const FaceGeometry& face)
{
  if (face.type != CellType::quad4) return true;
  return (face.nodes[0] - face.nodes[1] + face.nodes[2] - face.nodes[3]).norm() < 1e-9 * face.size();
}

// Whether two facets lie in parallel planes, as in patch tests. Between curved surfaces exact integrals of facets are no gain.
bool flat(const FaceGeometry& a, const FaceGeometry& b)
{
  const Point normal = a.normal();
  const auto planar = [&](const FaceGeometry& face) {
    return std::all_of(face.nodes.begin(), face.nodes.end(),
                       [&](const Point& p) { return std::abs((p - face.nodes[0]).dot(normal)) < 1e-6 * face.size(); });
  };
  return planar(a) && planar(b);
}

struct Sample {
  Plane at;
  double weight;
};

// Products of bilinear functions of two parallelograms have degree 4 in the plane, of biquadratic ones 8; other quads make them
// rational, and only many points keep the patch test at rounding.
std::vector<Sample> samples(const std::vector<Plane>& polygon, bool polynomial, bool second_order)
{
  static const Rule low = gauss(4), middle = gauss(6), high = gauss(9);
  const Rule& rule = !polynomial ? high : second_order ? middle : low;
  Plane centre = Plane::Zero();
  for (const auto& p : polygon) centre += p / static_cast<double>(polygon.size());
  std::vector<Sample> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Plane a = polygon[i] - centre, b = polygon[(i + 1) % polygon.size()] - centre;
    const double twice = cross(a, b);
    if (!(twice > 0)) continue;
    for (std::size_t k = 0; k < rule.at.size(); ++k)  // the square collapsed to a triangle at the centre
      for (std::size_t l = 0; l < rule.at.size(); ++l)
        result.push_back(
            {centre + rule.at[k] * (a + rule.at[l] * (b - a)), twice * rule.at[k] * rule.weight[k] * rule.weight[l]});
  }
  return result;
}

std::vector<Sample> samples_on_line(double begin, double end)
{
  static const Rule rule = gauss(3);
  std::vector<Sample> result;
  for (std::size_t k = 0; k < rule.at.size(); ++k)
    result.push_back({{begin + rule.at[k] * (end - begin), 0}, (end - begin) * rule.weight[k]});
  return result;
}

double height_at(const FaceGeometry& face, const Frame& frame, const Eigen::Vector4d& shape)
{
  double height = 0;
  for (std::size_t i = 0; i < face.nodes.size(); ++i) height += shape[static_cast<Eigen::Index>(i)] * frame.height(face.nodes[i]);
  return height;
}

}  // namespace

Point FaceGeometry::centre() const
{
  Point sum = Point::Zero();
  for (const auto& p : nodes) sum += p;
  return sum / static_cast<double>(nodes.size());
}

Point FaceGeometry::normal() const
{
  if (type == CellType::line2) return Point(nodes[1][1] - nodes[0][1], nodes[0][0] - nodes[1][0], 0).normalized();
  if (type == CellType::tri3) return (nodes[1] - nodes[0]).cross(nodes[2] - nodes[0]).normalized();
  return (nodes[2] - nodes[0]).cross(nodes[3] - nodes[1]).normalized();
}

double FaceGeometry::size() const
{
  double result = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) result = std::max(result, (nodes[i] - nodes[j]).norm());
  return result;
}

double FaceGeometry::area() const
{
  if (type == CellType::line2) return (nodes[1] - nodes[0]).norm();
  if (type == CellType::tri3) return 0.5 * (nodes[1] - nodes[0]).cross(nodes[2] - nodes[0]).norm();
  return 0.5 * (nodes[2] - nodes[0]).cross(nodes[3] - nodes[1]).norm();
}

FaceGeometry corners_of(const mesh::Surface& surface, std::size_t face)
{
  const CellType type = mesh::first_order(surface.faces.type[face]);
  FaceGeometry result{type, {}};
  for (const Local n : surface.faces[face].first(static_cast<std::size_t>(mesh::node_count(type))))
    result.nodes.push_back(surface.points[static_cast<std::size_t>(n)]);
  return result;
}

Overlap overlap(const FaceGeometry& secondary, const FaceGeometry& primary, double reach, bool second_order)
{
  const Frame frame = frame_of(secondary);
  if (frame.normal.dot(primary.normal()) > opposed) return {};
  std::vector<Plane> own, other;
  for (const auto& p : secondary.nodes) own.push_back(frame.project(p));
  for (const auto& p : primary.nodes) other.push_back(frame.project(p));

  std::vector<Sample> points;
  Plane middle = Plane::Zero();
  if (secondary.type == CellType::line2) {
    const double begin = std::max(std::min(own[0][0], own[1][0]), std::min(other[0][0], other[1][0]));
    const double end = std::min(std::max(own[0][0], own[1][0]), std::max(other[0][0], other[1][0]));
    if (end - begin <= negligible * secondary.area()) return {};
    points = samples_on_line(begin, end);
    middle[0] = 0.5 * (begin + end);
  } else {
    std::vector<Plane> subject(other.rbegin(), other.rend());  // it looks the other way
    if (area_of(subject) < 0) return {};
    const auto common = clip_polygon(subject, own);
    if (common.size() < 3 || area_of(common) <= negligible * secondary.area()) return {};
    const bool polynomial = (parallelogram(secondary) && parallelogram(primary)) || !flat(secondary, primary);
    points = samples(common, polynomial, second_order);
    for (const auto& p : common) middle += p / static_cast<double>(common.size());
  }
  const double distance = height_at(primary, frame, shape(primary.type, locate(primary.type, other, middle))) -
                          height_at(secondary, frame, shape(secondary.type, locate(secondary.type, own, middle)));
  if (std::abs(distance) > reach) return {};
  Overlap result{frame, {}};
  for (const auto& sample : points)
    result.points.push_back({sample.weight, sample.at, shape(secondary.type, locate(secondary.type, own, sample.at)),
                             shape(primary.type, locate(primary.type, other, sample.at))});
  return result;
}

Hit shoot(const Point& from, const Point& direction, const FaceGeometry& face)
{
  constexpr double margin = 1e-6;  // of the face's size: rays on an edge hit one of its faces
  if (direction.dot(face.normal()) > opposed) return {};
  Frame frame{from, Point::Zero(), Point::Zero(), direction};
  if (face.type == CellType::line2) {
    frame.first = Point(-direction[1], direction[0], 0);
  } else {
    frame.first = direction.unitOrthogonal();
    frame.second = direction.cross(frame.first);
  }
  std::vector<Plane> nodes;
  for (const auto& p : face.nodes) nodes.push_back(frame.project(p));
  Hit hit;
  hit.shape = shape(face.type, locate(face.type, nodes, Plane::Zero()));
  hit.found = hit.shape.head(static_cast<Eigen::Index>(nodes.size())).minCoeff() >= -margin;
  hit.distance = height_at(face, frame, hit.shape);
  hit.frame = frame;
  return hit;
}

}  // namespace mortise::contact
