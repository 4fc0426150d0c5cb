#include "surface/bulge.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::contact {

namespace {

// Lines that are flatter than this to a face are taken to be as flat as this.
constexpr double least_cosine = 0.3;

// The permanent of a 3 x 3 matrix with these rows.
double permanent(const Eigen::Vector3d& u, const Eigen::Vector3d& v, const Eigen::Vector3d& w)
{
  return u[0] * (v[1] * w[2] + v[2] * w[1]) + u[1] * (v[0] * w[2] + v[2] * w[0]) + u[2] * (v[0] * w[1] + v[1] * w[0]);
}

// The factor of N_0 N_1 N_2 for which sum odd_i N_i N_j (N_i - N_j), j = i + 1, has the least third derivatives on a triangle:
// the scalar product of two symmetric products of gradients of the N is the permanent of those of the gradients.
double bubble_on(const FaceGeometry& face, const std::array<double, 4>& odd)
{
  Eigen::Matrix3d across;  // edges, opposite their corners: turned by a right angle, gradients but for one factor
  for (int i = 0; i < 3; ++i)
    across.col(i) = face.nodes[static_cast<std::size_t>((i + 2) % 3)] - face.nodes[static_cast<std::size_t>((i + 1) % 3)];
  const Eigen::Matrix3d products = across.transpose() * across;
  const auto row = [&](int i) { return Eigen::Vector3d(products.col(i)); };
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    sum += odd[static_cast<std::size_t>(i)] * (permanent(row(i), row(i), row(j)) - permanent(row(i), row(j), row(j)));
  }
  const double whole = permanent(row(0), row(1), row(2));
  return whole > 0 ? -sum / whole : 0;
}

}  // namespace

Bulge::Bulge(const FaceGeometry& face, std::span<const Point> normals, bool cubic) : n_(face.nodes.size())
{
  const auto slope = [&](std::size_t i, std::size_t j) { return (face.nodes[i] - face.nodes[j]).dot(normals[i]); };
  for (std::size_t i = 0; i < n_; ++i) {
    const std::size_t next = (i + 1) % n_;
    for (std::size_t j = 0; j < i; ++j) mean_[i][j] = (slope(i, j) + slope(j, i)) / 2;
    odd_[i] = !cubic || (n_ == 2 && i == 1) ? 0 : (slope(i, next) - slope(next, i)) / 2;
    normal_[i] = normals[i];
  }
  if (n_ == 3) bubble_ = bubble_on(face, odd_);
}

Bulge::Bulge(const Side& side, const SurfaceNodes& surface_nodes, std::size_t facet, std::span<const Point> normals)
    : Bulge(side.geometry(facet), corners(side, surface_nodes, facet, normals))
{
}

Bulge::Corners Bulge::corners(const Side& side, const SurfaceNodes& surface_nodes, std::size_t facet,
                              std::span<const Point> normals)
{
  const auto begin = static_cast<std::size_t>(side.facets.offset[facet]);
  const auto at = [&](std::size_t k) { return static_cast<std::size_t>(surface_nodes.of_corner[begin + k]); };
  Corners result{{}, true};
  for (std::size_t k = 0; k < side.facets[facet].size(); ++k) result.cubic = result.cubic && surface_nodes.all[at(k)].third_order;
  for (std::size_t k = 0; k < side.facets[facet].size(); ++k) {
    const auto& node = surface_nodes.all[at(k)];
    const Point normal = normals.empty() ? node.normal : normals[at(k)];
    result.normals.push_back(result.cubic ? normal : Point(normal + node.lean));
  }
  return result;
}

double Bulge::operator()(const Eigen::Vector4d& shape) const
{
  const double h = height(shape);
  return h == 0 ? 0 : 2 * h / (1 + mean_normal(shape).norm());
}

// Over so little the smooth surface is its tangent plane.
double Bulge::along(const Point& line, const Eigen::Vector4d& shape) const
{
  const double h = height(shape);
  if (h == 0) return 0;
  const Point mean = mean_normal(shape);
  const double size = mean.norm();
  return 2 * h / (1 + size) / std::max(std::abs(line.dot(mean)) / size, least_cosine);
}

Point Bulge::mean_normal(const Eigen::Vector4d& shape) const
{
  Point mean = Point::Zero();
  for (std::size_t i = 0; i < n_; ++i) mean += shape[static_cast<Eigen::Index>(i)] * normal_[i];
  return mean;
}

double Bulge::height(const Eigen::Vector4d& shape) const
{
  const auto at = [&](std::size_t i) { return shape[static_cast<Eigen::Index>(i % n_)]; };
  double result = 0;
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < i; ++j) result += at(i) * at(j) * mean_[i][j];
  for (std::size_t i = 0; i < n_; ++i) {
    const double opposite = n_ == 4 ? 1 : 0;
    const double a = at(i) + opposite * at(i + 3), b = at(i + 1) + opposite * at(i + 2),
                 c = opposite == 0 ? 1 : at(i) + at(i + 1);
    result += odd_[i] * a * b * (a - b) * c;
  }
  return n_ == 3 ? result + bubble_ * at(0) * at(1) * at(2) : result;
}

}  // namespace mortise::contact
