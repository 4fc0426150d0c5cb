#include "bem/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"

namespace mortise::bem {

namespace {

// Each edge as often one way as the other: once, or twice where two parts of the body touch in it.
void require_closed(const Panels& panels)
{
  std::map<std::pair<Local, Local>, int> surplus;
  for (const auto& c : panels.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(c[k], c[(k + 1) % 3]);
      surplus[{low, high}] += c[k] == low ? 1 : -1;
    }
  for (const auto& [edge, count] : surplus) {
    if (count == 0) continue;
    const Point middle =
        (panels.points[static_cast<std::size_t>(edge.first)] + panels.points[static_cast<std::size_t>(edge.second)]) / 2;
    throw Error(
        ExitStatus::bad_input,
        fmt::format("the surface is not closed, or its triangles are not turned alike: the edge at ({:.6g}, {:.6g}, {:.6g}) does "
                    "not belong to two triangles that run along it in opposite directions",
                    middle[0], middle[1], middle[2]));
  }
}

}  // namespace

Point Panels::gradient(std::size_t panel, int k) const
{
  return normal[panel].cross(corner(panel, (k + 2) % 3) - corner(panel, (k + 1) % 3)) / (2 * area[panel]);
}

Panels make_panels(std::vector<Point> points, std::vector<std::array<Local, 3>> corners)
{
  Panels panels{std::move(points), std::move(corners), {}, {}};
  double volume = 0;
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const Point &a = panels.corner(p, 0), &b = panels.corner(p, 1), &c = panels.corner(p, 2);
    const Point twice = (b - a).cross(c - a);
    const double length = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!(twice.norm() > 1e-12 * length * length))
      throw Error(ExitStatus::bad_input,
                  fmt::format("a triangle of the surface at ({:.6g}, {:.6g}, {:.6g}) has no area", a[0], a[1], a[2]));
    panels.normal.push_back(twice.normalized());
    panels.area.push_back(twice.norm() / 2);
    volume += (a - panels.points.front()).dot(twice) / 6;
  }
  require_closed(panels);
  if (!(volume > 0)) throw Error(ExitStatus::bad_input, "the surface encloses no volume, or its triangles are turned inward");
  return panels;
}

Panels make_panels(const mesh::Mesh& mesh)
{
  std::vector<std::array<Local, 3>> corners;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) corners.push_back({mesh.cells[c][0], mesh.cells[c][1], mesh.cells[c][2]});
  return make_panels(mesh.points, std::move(corners));
}

Eigen::VectorXd linear_field(const Panels& panels, const Point& offset, const Eigen::Matrix3d& gradient, const Point& origin)
{
  Eigen::VectorXd u(3 * panels.node_count());
  for (Eigen::Index n = 0; n < panels.node_count(); ++n)
    u.segment<3>(3 * n) = offset + gradient * (panels.points[static_cast<std::size_t>(n)] - origin);
  return u;
}

}  // namespace mortise::bem
