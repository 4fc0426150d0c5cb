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

// As many lines begin in a node as end there.
void require_closed(const PlanePanels& panels)
{
  std::vector<int> surplus(panels.points.size(), 0);
  for (const auto& c : panels.corners) {
    ++surplus[static_cast<std::size_t>(c[0])];
    --surplus[static_cast<std::size_t>(c[1])];
  }
  const auto open = std::find_if(surplus.begin(), surplus.end(), [](int count) { return count != 0; });
  if (open == surplus.end()) return;
  const Point& x = panels.points[static_cast<std::size_t>(open - surplus.begin())];
  throw Error(
      ExitStatus::bad_input,
      fmt::format("the border is not closed, or its lines are not turned alike: at ({:.6g}, {:.6g}) not as many begin as end",
                  x[0], x[1]));
}

template <int D>
PanelsIn<D> panels_of(const mesh::Mesh& mesh)
{
  std::vector<std::array<Local, D>> corners(mesh.cells.size());
  for (std::size_t c = 0; c < corners.size(); ++c)
    for (std::size_t k = 0; k < D; ++k) corners[c][k] = mesh.cells[c][k];
  return make_panels(mesh.points, std::move(corners));
}

}  // namespace

template <>
Point PanelsIn<3>::gradient(std::size_t panel, int k) const
{
  return normal[panel].cross(corner(panel, (k + 2) % 3) - corner(panel, (k + 1) % 3)) / (2 * area[panel]);
}

template <>
Point PanelsIn<2>::gradient(std::size_t panel, int k) const
{
  return (corner(panel, k) - corner(panel, 1 - k)) / (area[panel] * area[panel]);
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

PlanePanels make_panels(std::vector<Point> points, std::vector<std::array<Local, 2>> corners)
{
  PlanePanels panels{std::move(points), std::move(corners), {}, {}};
  double area = 0;
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const Point &a = panels.corner(p, 0), along = panels.corner(p, 1) - a, outward(along[1], -along[0], 0);
    const double length = along.norm();
    if (!(length > 0))
      throw Error(ExitStatus::bad_input, fmt::format("a line of the border at ({:.6g}, {:.6g}) has no length", a[0], a[1]));
    panels.normal.push_back(outward / length);
    panels.area.push_back(length);
    area += (a - panels.points.front()).dot(outward) / 2;
  }
  require_closed(panels);
  if (!(area > 0)) throw Error(ExitStatus::bad_input, "the border encloses no area, or its lines are turned inward");
  return panels;
}

template <>
PanelsIn<3> make_panels(const mesh::Mesh& mesh)
{
  return panels_of<3>(mesh);
}
template <>
PanelsIn<2> make_panels(const mesh::Mesh& mesh)
{
  return panels_of<2>(mesh);
}

template <int D>
Eigen::VectorXd linear_field(const PanelsIn<D>& panels, const Point& offset, const Eigen::Matrix3d& gradient, const Point& origin)
{
  Eigen::VectorXd u(D * panels.node_count());
  for (Eigen::Index n = 0; n < panels.node_count(); ++n)
    u.segment<D>(D * n) = flattened<D>(offset + gradient * (panels.points[static_cast<std::size_t>(n)] - origin));
  return u;
}
template Eigen::VectorXd linear_field(const PanelsIn<2>&, const Point&, const Eigen::Matrix3d&, const Point&);
template Eigen::VectorXd linear_field(const PanelsIn<3>&, const Point&, const Eigen::Matrix3d&, const Point&);

}  // namespace mortise::bem
