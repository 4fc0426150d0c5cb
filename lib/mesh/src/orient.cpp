#include "orient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gmsh_file.hpp"
#include "mesh/topology.hpp"

namespace mortise::mesh {

namespace {

// Six times the volume of the corner tetrahedra added up (2D: twice the area): the sign is the orientation.
double orientation(CellType type, std::span<const Local> nodes, const std::vector<Point>& points)
{
  const auto p = [&](std::size_t i) { return points[static_cast<std::size_t>(nodes[i])]; };
  if (dimension(type) == 2) {
    double area = 0;
    const auto corners = static_cast<std::size_t>(corner_count(type));
    for (std::size_t i = 0; i < corners; ++i) {
      const Point a = p(i) - p(0), b = p((i + 1) % corners) - p(0);
      area += a[0] * b[1] - a[1] * b[0];
    }
    return area;
  }
  double volume = 0;  // divergence theorem over the faces, each fanned from its first node
  for (const auto& face : faces(first_order(type)))
    for (std::size_t i = 1; i + 1 < face.nodes.size(); ++i) {
      const auto at = [&](std::size_t k) { return Point(p(static_cast<std::size_t>(face.nodes[k])) - p(0)); };
      volume += at(0).dot(at(i).cross(at(i + 1)));
    }
  return volume;
}

// The corners of a cell turned inside out, as corners of the cell as it is.
std::vector<int> reversed_corners(CellType first_order)
{
  using enum CellType;
  switch (first_order) {
    case tri3:
      return {0, 2, 1};
    case quad4:
      return {0, 3, 2, 1};
    case tet4:
      return {0, 2, 1, 3};
    case hex8:
      return {4, 5, 6, 7, 0, 1, 2, 3};
    case prism6:
      return {3, 4, 5, 0, 1, 2};
    default:  // line2
      return {1, 0};
  }
}

}  // namespace

std::vector<Local> reversed(CellType type, std::span<const Local> nodes)
{
  const auto corner = reversed_corners(first_order(type));
  std::vector<Local> result;
  for (const int c : corner) result.push_back(nodes[static_cast<std::size_t>(c)]);
  for (const auto& amid : middles(type)) {
    std::vector<int> old;
    for (const int c : amid) old.push_back(corner[static_cast<std::size_t>(c)]);
    result.push_back(nodes[static_cast<std::size_t>(node_amid(type, old))]);
  }
  return result;
}

namespace {

// Corners of a face that are neighbours: two nodes in one place, which are meant to be one.
void require_edges(const RawMesh& raw, std::size_t cell, double size, const std::string& file)
{
  const auto nodes = raw.cells[cell];
  for (const auto& face : faces(first_order(raw.cells.type[cell])))
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
      const auto at = [&](std::size_t k) {
        return raw.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(face.nodes[k % face.nodes.size()])])];
      };
      const Point x = at(i);
      if ((at(i + 1) - x).stableNorm() > 1e-9 * size) continue;
      fail(file,
           fmt::format("element {} ({}) of body \"{}\" has two nodes in one place, ({:.6g}, {:.6g}, {:.6g}); let it name one of "
                       "them twice (a wedge as a brick, a triangle as a quadrilateral) or merge them",
                       raw.tag[cell], name(raw.cells.type[cell]), raw.volumes[static_cast<std::size_t>(raw.volume[cell])], x[0],
                       x[1], x[2]));
    }
}

}  // namespace

void orient(RawMesh& raw, const Options& options, int dimension)
{
  Cells right;
  for (std::size_t c = 0; c < raw.cells.size(); ++c) {
    const CellType type = raw.cells.type[c];
    const auto nodes = raw.cells[c];
    if (!is_solid(type, dimension)) {
      right.add(type, nodes);
      continue;
    }
    const double volume = orientation(type, nodes, raw.points);
    Point low = raw.points[static_cast<std::size_t>(nodes[0])], high = low;
    for (const Local n : nodes) {
      low = low.cwiseMin(raw.points[static_cast<std::size_t>(n)]);
      high = high.cwiseMax(raw.points[static_cast<std::size_t>(n)]);
    }
    require_edges(raw, c, (high - low).maxCoeff(), options.file);
    if (std::abs(volume) <= 1e-12 * std::pow((high - low).maxCoeff(), dimension))
      fail(options.file, fmt::format("element {} ({}) of body \"{}\" has no volume; improve the mesh there", raw.tag[c],
                                     name(type), raw.volumes[static_cast<std::size_t>(raw.volume[c])]));
    if (volume < 0)
      right.add(type, reversed(type, nodes));
    else
      right.add(type, nodes);
  }
  raw.cells = std::move(right);
}

}  // namespace mortise::mesh
