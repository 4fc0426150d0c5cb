#include "mesh/face_area.hpp"

#include <Eigen/Geometry>

namespace mortise::mesh {

Point area_vector(const std::vector<Point>& points, std::span<const Local> nodes, CellType type)
{
  const auto at = [&](std::size_t i) -> const Point& { return points[static_cast<std::size_t>(nodes[i])]; };
  switch (corner_count(type)) {
    case 2:
      return {at(1)[1] - at(0)[1], at(0)[0] - at(1)[0], 0};
    case 3:
      return (at(1) - at(0)).cross(at(2) - at(0)) / 2;
    default:
      return (at(2) - at(0)).cross(at(3) - at(1)) / 2;
  }
}

}  // namespace mortise::mesh
