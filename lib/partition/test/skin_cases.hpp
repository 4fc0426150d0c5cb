// What skins are measured by: volumes, areas, edges; and blocks of all cells.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mesh/topology.hpp"
#include "partition/skins.hpp"
#include "testing/cut.hpp"

namespace mortise::partition {

inline Options metis(int unknowns)
{
  Options options;
  options.unknowns_per_subdomain = unknowns;
  return options;
}

inline const Point& at(const mesh::Mesh& mesh, Local node)
{
  return mesh.points[static_cast<std::size_t>(node)];
}

// Area times outward normal of a flat triangle, or of a line in a plane.
inline Point normal(const std::vector<Point>& points, std::span<const Local> nodes)
{
  const auto x = [&](std::size_t i) { return points[static_cast<std::size_t>(nodes[i])]; };
  if (nodes.size() == 2) return {x(1)[1] - x(0)[1], x(0)[0] - x(1)[0], 0};
  return 0.5 * (x(1) - x(0)).cross(x(2) - x(0));
}

// By the divergence theorem: the integral of x.n over the panels is dimension times the volume.
inline double volume(const mesh::Mesh& skin)
{
  double sum = 0;
  for (std::size_t c = 0; c < skin.cells.size(); ++c) {
    Point middle = Point::Zero();
    for (const Local n : skin.cells[c]) middle += at(skin, n);
    sum += middle.dot(normal(skin.points, skin.cells[c])) / static_cast<double>(skin.cells[c].size());
  }
  return sum / (skin.cells.type.front() == mesh::CellType::line2 ? 2 : 3);
}

// Of straight cells: through the triangles from a node of each face's corners.
inline double volume_of_cells(const mesh::Mesh& mesh)
{
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    const Point origin = at(mesh, nodes[0]);
    for (const auto& face : mesh::faces(mesh.cells.type[c])) {
      const auto x = [&](int i) -> Point {
        return at(mesh, nodes[static_cast<std::size_t>(face.nodes[static_cast<std::size_t>(i)])]) - origin;
      };
      const int corners = mesh::corner_count(face.type);
      if (corners == 2) sum += (x(0)[0] * x(1)[1] - x(0)[1] * x(1)[0]) / 2;
      for (int k = 2; k < corners; ++k) sum += x(0).dot(x(k - 1).cross(x(k))) / 6;
    }
  }
  return sum;
}

// How often each edge of the panels (plane models: each end) is run along, less how often the other way: of a closed skin 0. And
// how many edges belong to more than two panels.
struct Edges {
  int open = 0, crowded = 0;
};
inline Edges edges(const mesh::Cells& panels)
{
  std::map<std::pair<Local, Local>, std::pair<int, int>> all;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const auto n = panels[p];
    if (n.size() == 2) {
      ++all[{n[0], n[0]}].first;
      ++all[{n[1], n[1]}].second;
    }
    for (std::size_t k = 0; n.size() == 3 && k < 3; ++k) {
      const Local a = n[k], b = n[(k + 1) % 3];
      auto& count = all[{std::min(a, b), std::max(a, b)}];
      ++(a < b ? count.first : count.second);
    }
  }
  Edges result;
  for (const auto& [edge, count] : all) {
    result.open += count.first != count.second ? 1 : 0;
    result.crowded += count.first > 1 ? 1 : 0;
  }
  return result;
}

// Of the facets of each boundary: their number and their areas, exact for flat faces. Over all ranks.
inline std::vector<double> areas(const Decomposition& d, const Communicator& comm)
{
  std::vector<double> sums(4 * d.catalogue.boundaries.size(), 0.0);
  for (const auto& subdomain : d.subdomains) {
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.cells.size(); ++f) {
      auto nodes = facets.cells[f].first(static_cast<std::size_t>(mesh::corner_count(facets.cells.type[f])));
      Point sum = nodes.size() == 2 ? normal(subdomain.mesh.points, nodes) : Point(Point::Zero());
      for (std::size_t k = 2; k < nodes.size(); ++k)
        sum += normal(subdomain.mesh.points, std::array{nodes[0], nodes[k - 1], nodes[k]});
      for (Eigen::Index c = 0; c < 3; ++c)
        sums[4 * static_cast<std::size_t>(facets.boundary[f]) + static_cast<std::size_t>(c)] += sum[c];
      sums[4 * static_cast<std::size_t>(facets.boundary[f]) + 3] += sum.norm();
    }
  }
  comm.sum_in_place(sums);
  return sums;
}

struct Case {
  std::string element;
  int dimension;
  int unknowns;
};
inline const std::vector<Case> cases{{"hex8", 3, 60},   {"tet4", 3, 60},   {"prism6", 3, 60},   {"hex20", 3, 200},
                                     {"hex27", 3, 600}, {"tet10", 3, 600}, {"prism15", 3, 300}, {"prism18", 3, 600},
                                     {"quad4", 2, 15},  {"tri3", 2, 15},   {"quad8", 2, 40},    {"quad9", 2, 40},
                                     {"tri6", 2, 40}};

inline Decomposition cut_of(const Case& c, const Communicator& comm)
{
  return cut_of(two_blocks(c.element, {6, 4, 4}, {4, 3, 2}, c.dimension == 2), metis(c.unknowns), comm, c.dimension);
}

}  // namespace mortise::partition
