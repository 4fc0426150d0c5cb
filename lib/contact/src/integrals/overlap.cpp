#include "integrals/overlap.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace mortise::contact {

using mesh::CellType;

namespace {

constexpr double negligible_overlap = 1e-10;  // part of the face's area below which an overlap is rounding

// Part of `subject` inside the convex, counter-clockwise `clip` [Sutherland and Hodgman].
Polygon clip_polygon(Polygon subject, const Few<Plane, 4>& clip)
{
  for (std::size_t e = 0; e < clip.size() && !subject.empty(); ++e) {
    const Plane a = clip[e], edge = clip[(e + 1) % clip.size()] - a;
    Polygon kept;
    for (std::size_t i = 0; i < subject.size(); ++i) {
      const Plane &p = subject[i], &q = subject[(i + 1) % subject.size()];
      const double dp = cross(edge, p - a), dq = cross(edge, q - a);
      if (dp >= 0) kept.push_back(p);
      if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
    }
    subject = kept;
  }
  return subject;
}

// Of the bilinear map of a quadrilateral x = c + a s + b t + d s t, whose Jacobian in the plane is a x b + a x d s + d x b t.
double variation_of_jacobian(const FaceGeometry& face)
{
  if (face.type != CellType::quad4) return 0;
  const auto& x = face.nodes;
  const Point d = x[0] - x[1] + x[2] - x[3];
  if (d.norm() < 1e-9 * face.size()) return 0;
  const Point a = x[1] + x[2] - x[0] - x[3], b = x[2] + x[3] - x[0] - x[1];
  return (a.cross(d).norm() + d.cross(b).norm()) / a.cross(b).norm();
}

// Whether two facets lie in parallel planes, as in patch tests. Between curved surfaces exact integrals of facets are no gain.
bool parallel_planes(const FaceGeometry& a, const FaceGeometry& b)
{
  const Point normal = a.normal();
  const auto planar = [&](const FaceGeometry& face) {
    return std::all_of(face.nodes.begin(), face.nodes.end(),
                       [&](const Point& p) { return std::abs((p - face.nodes[0]).dot(normal)) < 1e-6 * face.size(); });
  };
  return planar(a) && planar(b);
}

// Products of bilinear functions are polynomials in the plane where the faces are parallelograms.
Integrand integrand(const FaceGeometry& secondary, const FaceGeometry& primary, bool second_order)
{
  const double variation = std::max(variation_of_jacobian(secondary), variation_of_jacobian(primary));
  return {second_order, parallel_planes(secondary, primary) ? variation : 0};
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

Frame frame_of(const FaceGeometry& face)
{
  Frame frame{face.centre(), (face.nodes[1] - face.nodes[0]).normalized(), Point::Zero(), face.normal()};
  frame.first = (frame.first - frame.first.dot(frame.normal) * frame.normal).normalized();
  if (face.type != CellType::line2) frame.second = frame.normal.cross(frame.first);
  return frame;
}

FaceGeometry corners_of(const mesh::Surface& surface, std::size_t face)
{
  const CellType type = mesh::first_order(surface.faces.type[face]);
  FaceGeometry result{type, {}};
  for (const Local n : surface.faces[face].first(static_cast<std::size_t>(mesh::node_count(type))))
    result.nodes.push_back(surface.points[static_cast<std::size_t>(n)]);
  return result;
}

bool overlap(const FaceGeometry& secondary, const FaceGeometry& primary, double reach, bool second_order, Overlap& result)
{
  result.points.clear();
  const Frame frame = result.frame = frame_of(secondary);
  if (frame.normal.dot(primary.normal()) > opposed) return false;
  Few<Plane, 4> own, other;
  for (const auto& p : secondary.nodes) own.push_back(frame.project(p));
  for (const auto& p : primary.nodes) other.push_back(frame.project(p));

  Plane middle = Plane::Zero();
  if (secondary.type == CellType::line2) {
    const double begin = std::max(std::min(own[0][0], own[1][0]), std::min(other[0][0], other[1][0]));
    const double end = std::min(std::max(own[0][0], own[1][0]), std::max(other[0][0], other[1][0]));
    if (end - begin <= negligible_overlap * secondary.area()) return false;
    sample(begin, end, result.samples);
    result.common = {Plane(begin, 0), Plane(end, 0)};
    middle[0] = 0.5 * (begin + end);
  } else {
    Polygon subject;  // it looks the other way
    for (std::size_t i = other.size(); i > 0; --i) subject.push_back(other[i - 1]);
    if (area_of(subject) < 0) return false;
    const auto common = clip_polygon(subject, own);
    if (common.size() < 3 || area_of(common) <= negligible_overlap * secondary.area()) return false;
    sample(common, integrand(secondary, primary, second_order), result.samples);
    for (const auto& p : common) middle += p / static_cast<double>(common.size());
    result.common = common;
  }
  const Locator in_secondary(secondary.type, own), in_primary(primary.type, other);
  const double height = height_at(secondary, frame, in_secondary(middle));
  result.distance = height_at(primary, frame, in_primary(middle)) - height;
  if (std::abs(result.distance) > reach) return false;
  result.middle = frame.origin + middle[0] * frame.first + middle[1] * frame.second + height * frame.normal;
  for (const auto& at : result.samples) result.points.push_back({at.weight, at.at, in_secondary(at.at), in_primary(at.at)});
  return true;
}

Hit shoot(const Point& from, const Point& direction, const FaceGeometry& face, double margin)
{
  if (direction.dot(face.normal()) > opposed) return {};
  Frame frame{from, Point::Zero(), Point::Zero(), direction};
  if (face.type == CellType::line2) {
    frame.first = Point(-direction[1], direction[0], 0);
  } else {
    frame.first = direction.unitOrthogonal();
    frame.second = direction.cross(frame.first);
  }
  Few<Plane, 4> nodes;
  for (const auto& p : face.nodes) nodes.push_back(frame.project(p));
  Hit hit;
  hit.shape = Locator(face.type, nodes)(Plane::Zero());
  hit.found = hit.shape.head(static_cast<Eigen::Index>(nodes.size())).minCoeff() >= -margin;
  hit.distance = height_at(face, frame, hit.shape);
  hit.frame = frame;
  return hit;
}

}  // namespace mortise::contact
