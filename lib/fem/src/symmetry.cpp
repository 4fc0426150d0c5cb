#include "fem/symmetry.hpp"

#include <cmath>

#include "tensor.hpp"

namespace mortise::fem {

namespace {

constexpr double orthogonal = 1e-2;  // cosine of the angle between normals of meshes

// Appends what `vector` has besides the orthonormal `basis`, if that is more than rounding.
void extend(std::vector<Point>& basis, const Point& vector)
{
  Point rest = vector;
  for (int sweep = 0; sweep < 2; ++sweep)
    for (const Point& b : basis) rest -= b.dot(rest) * b;
  if (basis.empty())
    basis.push_back(vector);
  else if (rest.norm() > orthogonal)
    basis.push_back(rest.normalized());
}

}  // namespace

std::vector<std::vector<Point>> mirrored_spaces(std::span<const Point> normals)
{
  std::vector<std::vector<Point>> spaces;
  for (const Point& normal : normals) {
    std::vector<Point> joined;
    std::erase_if(spaces, [&](const std::vector<Point>& space) {
      double square = 0;
      for (const Point& b : space) square += b.dot(normal) * b.dot(normal);
      if (std::sqrt(square) < orthogonal) return false;
      for (const Point& b : space) extend(joined, b);
      return true;
    });
    extend(joined, normal);
    spaces.push_back(std::move(joined));
  }
  return spaces;
}

Stress symmetric_stress(const Stress& stress, std::span<const Point> normals)
{
  const Tensor s = tensor(stress);
  Tensor rest = Tensor::Identity(), result = Tensor::Zero();
  for (const auto& space : mirrored_spaces(normals)) {
    Tensor projector = Tensor::Zero();
    for (const Point& b : space) projector += b * b.transpose();
    result += (projector * s).trace() / static_cast<double>(space.size()) * projector;
    rest -= projector;
  }
  return entries(result + rest * s * rest);
}

Stress stress_with_traction(const Stress& stress, const Point& normal, double traction)
{
  const Tensor s = tensor(stress);
  return entries(s + (traction - normal.dot(s * normal)) * normal * normal.transpose());
}

Stress rotated_stress(const Stress& stress, const Eigen::Matrix3d& rotation)
{
  return entries(rotation * tensor(stress) * rotation.transpose());
}

}  // namespace mortise::fem
