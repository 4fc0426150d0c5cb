#include "partition/congruence.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <unordered_map>

namespace mortise::partition {

namespace {

constexpr double tolerance = 1e-10;  // of distances, relative to the size of the subdomain

bool same_cells(const mesh::Cells& a, const mesh::Cells& b)
{
  return a.type == b.type && a.nodes == b.nodes;
}

Point centroid(const std::vector<Point>& points)
{
  Point sum = Point::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

// A subdomain prepared for comparison.
struct Shape {
  const mesh::Mesh* mesh;
  Point centre;
  double size;
  double allowed;  // by which points may differ: what rounding makes of coordinates far from the origin included
};

Shape shape(const mesh::Mesh& mesh)
{
  Shape result{&mesh, centroid(mesh.points), 0, 0};
  for (const auto& p : mesh.points) result.size = std::max(result.size, (p - result.centre).norm());
  result.allowed = tolerance * result.size + 16 * std::numeric_limits<double>::epsilon() * result.centre.norm();
  return result;
}

bool coincide(const Shape& a, const Shape& b, const Eigen::Matrix3d& rotation)
{
  for (std::size_t n = 0; n < a.mesh->points.size(); ++n)
    if ((rotation * (a.mesh->points[n] - a.centre) - (b.mesh->points[n] - b.centre)).norm() > std::max(a.allowed, b.allowed))
      return false;
  return true;
}

// Distances from the centre, which no rigid motion changes.
bool equally_far(const Shape& a, const Shape& b)
{
  for (std::size_t n = 0; n < a.mesh->points.size(); ++n)
    if (std::abs((a.mesh->points[n] - a.centre).norm() - (b.mesh->points[n] - b.centre).norm()) > std::max(a.allowed, b.allowed))
      return false;
  return true;
}

// The rotation that brings a nearest to b [Kabsch, Acta Cryst. A32 (1976) 922].
Eigen::Matrix3d best_rotation(const Shape& a, const Shape& b)
{
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < a.mesh->points.size(); ++n)
    covariance += (b.mesh->points[n] - b.centre) * (a.mesh->points[n] - a.centre).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

// Whether b is a copy of a, and how it is turned.
std::optional<CopyOf> compare(std::size_t index, const Shape& a, const Shape& b, Motions motions)
{
  if (motions == Motions::along_y && std::abs(a.centre[0] - b.centre[0]) > tolerance * a.size) return {};
  if (a.mesh->points.size() != b.mesh->points.size() || !same_cells(a.mesh->cells, b.mesh->cells)) return {};
  if (coincide(a, b, Eigen::Matrix3d::Identity())) return CopyOf{index, {}};
  if (motions != Motions::rigid || !equally_far(a, b)) return {};
  const Eigen::Matrix3d rotation = best_rotation(a, b);
  if (!coincide(a, b, rotation)) return {};
  return CopyOf{index, rotation};
}

}  // namespace

std::vector<CopyOf> congruent(const std::vector<Subdomain>& subdomains, const std::vector<int>& kind, Motions motions,
                              const Alike& alike)
{
  std::vector<CopyOf> result;
  std::vector<Shape> shapes;
  std::unordered_multimap<std::size_t, std::size_t> originals;  // by what is cheap to compare
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& mesh = subdomains[s].mesh;
    shapes.push_back(shape(mesh));
    const std::size_t key = (mesh.node_count() * 1000003U + mesh.cells.size()) * 1000003U + static_cast<std::size_t>(kind[s]);
    std::optional<CopyOf> found;
    const auto [begin, end] = originals.equal_range(key);
    for (auto it = begin; it != end && !found; ++it)
      if (kind[it->second] == kind[s]) {
        found = compare(it->second, shapes[it->second], shapes[s], motions);
        if (found && alike &&
            !alike(subdomains[it->second], subdomains[s], found->rotation.value_or(Eigen::Matrix3d::Identity())))
          found.reset();
      }
    if (!found) originals.emplace(key, s);
    result.push_back(found.value_or(CopyOf{s, {}}));
  }
  return result;
}

}  // namespace mortise::partition
