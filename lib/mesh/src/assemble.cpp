// From a mesh as it stands in a file to bodies with nodes of their own.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "closed_surfaces.hpp"
#include "conforming.hpp"
#include "gmsh_file.hpp"
#include "mesh/curved_surface.hpp"
#include "mesh/topology.hpp"
#include "orient.hpp"
#include "raw_mesh.hpp"

namespace mortise::mesh {

namespace {

// Parts of one body that share nodes, but no face, part there.
void warn_of_torn_bodies(const RawMesh& raw, const Groups& groups, const std::vector<int>& part, Assembly& assembly)
{
  std::map<int, int> of_label;
  bool several = false;  // parts of one label: else they are torn nowhere
  for (std::size_t c = 0; c < part.size(); ++c)
    several = several || of_label.emplace(groups.label[c], part[c]).first->second != part[c];
  if (!several) return;
  std::map<std::pair<Local, int>, int> first_part;  // node of the file and label -> part
  std::map<int, std::size_t> torn;                  // group -> nodes
  for (std::size_t c = 0; c < raw.cells.size(); ++c)
    for (const Local n : raw.cells[c])
      if (const auto [at, fresh] = first_part.emplace(std::pair(n, groups.label[c]), part[c]); !fresh && at->second != part[c]) {
        ++torn[groups.of_cell[c]];
        at->second = part[c];
      }
  for (const auto& [group, count] : torn)
    assembly.warnings.push_back(
        fmt::format("parts of body \"{}\" share an edge, a vertex or the nodes of unlike faces ({} nodes): they are separate "
                    "bodies there, which nothing ties; give them common faces, or contacts",
                    groups.names[static_cast<std::size_t>(group)], count));
}

// Volumes that are to be one body, but do not hang together.
void warn_of_scattered_volumes(const Groups& groups, const Options& options, const std::vector<int>& parts_in, Assembly& assembly)
{
  for (std::size_t g = 0; g < groups.names.size(); ++g)
    if (parts_in[g] > 1 && options.volumes.contains(groups.names[g]))
      assembly.warnings.push_back(
          fmt::format("the volumes of the body \"{0}\" share faces only within {1} parts, which are the bodies {0}.1 to {0}.{1}; "
                      "nothing ties them: let the volumes share their nodes where they meet, or add contacts",
                      groups.names[g], parts_in[g]));
}

// The body of each cell, numbered in the order of their smallest cells: connected parts, and surfaces with those of their
// cavities
// (`enclosed`, as close_surfaces() gives it).
std::vector<int> parts_of(const Neighbours& neighbours, const Groups& groups, const std::vector<int>& enclosed)
{
  auto part = connected_parts(neighbours, groups.label);
  std::map<int, int> of_surface, order;
  for (std::size_t c = 0; c < part.size(); ++c) {
    if (enclosed[c] >= 0) part[c] = of_surface.emplace(enclosed[c], part[c]).first->second;
    part[c] = order.emplace(part[c], static_cast<int>(order.size())).first->second;
  }
  return part;
}

// Cells ordered by body, with nodes of its own for each body.
Assembly separate(const RawMesh& raw, const Groups& groups, const std::vector<int>& part, const Options& options, int dimension,
                  std::vector<Local>& original, std::vector<int>& solid_of_cell)
{
  const int parts = 1 + *std::max_element(part.begin(), part.end());
  std::vector<int> group_of(static_cast<std::size_t>(parts)), parts_in(groups.names.size(), 0),
      order(static_cast<std::size_t>(parts));
  for (std::size_t c = part.size(); c-- > 0;) group_of[static_cast<std::size_t>(part[c])] = groups.of_cell[c];
  for (int p = 0; p < parts; ++p) order[static_cast<std::size_t>(p)] = p;
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return group_of[static_cast<std::size_t>(a)] < group_of[static_cast<std::size_t>(b)]; });
  for (const int g : group_of) ++parts_in[static_cast<std::size_t>(g)];

  Assembly assembly;
  assembly.catalogue.dimension = dimension;
  assembly.catalogue.volumes = raw.volumes;
  std::vector<std::vector<Local>> cells_of(static_cast<std::size_t>(parts));
  for (std::size_t c = 0; c < part.size(); ++c) cells_of[static_cast<std::size_t>(part[c])].push_back(static_cast<Local>(c));
  std::vector<int> numbered(groups.names.size(), 0);
  std::vector<Local> place(raw.points.size());  // of a node of the file among those of the body
  Mesh& mesh = assembly.mesh;
  for (const int p : order) {
    const auto g = static_cast<std::size_t>(group_of[static_cast<std::size_t>(p)]);
    const auto& name = groups.names[g];
    assembly.catalogue.bodies.push_back({parts_in[g] == 1 ? name : fmt::format("{}.{}", name, ++numbered[g]), name});
    const auto& cells = cells_of[static_cast<std::size_t>(p)];
    std::vector<Local> used;
    for (const Local c : cells)
      used.insert(used.end(), raw.cells[static_cast<std::size_t>(c)].begin(), raw.cells[static_cast<std::size_t>(c)].end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const Local n : used) {
      place[static_cast<std::size_t>(n)] = static_cast<Local>(mesh.points.size());
      mesh.node_id.push_back(static_cast<Global>(mesh.points.size()));
      mesh.points.push_back(raw.points[static_cast<std::size_t>(n)]);
      original.push_back(n);
    }
    for (const Local c : cells) {
      std::vector<Local> cell;
      for (const Local n : raw.cells[static_cast<std::size_t>(c)]) cell.push_back(place[static_cast<std::size_t>(n)]);
      mesh.cell_id.push_back(static_cast<Global>(mesh.cells.size()));
      mesh.cells.add(raw.cells.type[static_cast<std::size_t>(c)], cell);
      mesh.cell_body.push_back(static_cast<int>(assembly.catalogue.bodies.size()) - 1);
      if (!raw.solid.empty()) solid_of_cell.push_back(raw.solid[static_cast<std::size_t>(c)]);
      if (!options.volumes.empty()) mesh.cell_volume.push_back(raw.volume[static_cast<std::size_t>(c)]);
    }
  }
  warn_of_torn_bodies(raw, groups, part, assembly);
  warn_of_scattered_volumes(groups, options, parts_in, assembly);
  assembly.catalogue.node_count = static_cast<Global>(mesh.points.size());
  assembly.catalogue.cell_count = static_cast<Global>(mesh.cells.size());
  return assembly;
}

// Those of the solids, and surfaces themselves; in the order of sorted_faces().
std::vector<CellFace> faces_of_bodies(const Cells& cells, int dimension)
{
  auto all = sorted_faces(cells);
  std::erase_if(all, [&](const CellFace& face) { return !is_solid(cells.type[static_cast<std::size_t>(face.cell)], dimension); });
  const auto solid = all.size();
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (!is_solid(cells.type[c], dimension))
      all.push_back({face_key(cells[c].first(static_cast<std::size_t>(corner_count(cells.type[c])))), static_cast<Local>(c), 0});
  if (all.size() > solid)
    std::sort(all.begin(), all.end(),
              [](const CellFace& a, const CellFace& b) { return std::tie(a.corners, a.cell) < std::tie(b.corners, b.cell); });
  return all;
}

// Facets of the boundaries, found on the cells by the nodes of the file.
void attach_boundaries(const RawMesh& raw, const Options& options, const std::vector<Local>& original,
                       const std::vector<int>& solid_of_cell, Assembly& assembly)
{
  Mesh& mesh = assembly.mesh;
  Cells in_file = mesh.cells;
  for (auto& n : in_file.nodes) n = original[static_cast<std::size_t>(n)];
  const auto all = faces_of_bodies(in_file, assembly.catalogue.dimension);
  const auto body = [&](const CellFace& face) { return mesh.cell_body[static_cast<std::size_t>(face.cell)]; };
  const auto volume = [&](const CellFace& face) {
    return mesh.cell_volume.empty() ? 0 : mesh.cell_volume[static_cast<std::size_t>(face.cell)];
  };
  for (const auto& named : raw.boundaries) {
    const auto boundary = static_cast<int>(assembly.catalogue.boundaries.size());
    assembly.catalogue.boundaries.push_back(named.name);
    std::size_t lost = 0, inside = 0;
    std::set<std::pair<Local, int>> taken;  // files repeat a face for each group that it is in
    for (const auto& corners : named.faces) {
      const auto range = std::equal_range(all.begin(), all.end(), CellFace{corners},
                                          [](const CellFace& a, const CellFace& b) { return a.corners < b.corners; });
      if (range.first == range.second) {
        ++lost;
        continue;
      }
      if (range.second - range.first == 2 && body(*range.first) == body(*(range.first + 1))) {
        ++inside;
        if (!named.strict || volume(*range.first) != volume(*(range.first + 1))) continue;
        fail(options.file,
             fmt::format("boundary \"{}\" runs through the inside of body \"{}\"; only faces on the surface of a body can be a "
                         "boundary",
                         named.name, assembly.catalogue.bodies[static_cast<std::size_t>(body(*range.first))].name));
      }
      for (auto match = range.first; match != range.second; ++match) {
        if (named.solid >= 0 && solid_of_cell[static_cast<std::size_t>(match->cell)] != named.solid) continue;
        if (!taken.emplace(match->cell, match->face).second) continue;
        const auto cell = static_cast<std::size_t>(match->cell);
        const auto type = mesh.cells.type[cell];
        if (is_solid(type, assembly.catalogue.dimension)) {
          const auto& face = faces(type)[static_cast<std::size_t>(match->face)];
          std::vector<Local> facet;
          for (const int i : face.nodes) facet.push_back(mesh.cells[cell][static_cast<std::size_t>(i)]);
          mesh.facets.cells.add(face.type, facet);
        } else {
          mesh.facets.cells.add(type, std::vector<Local>(mesh.cells[cell].begin(), mesh.cells[cell].end()));
        }
        mesh.facets.parent.push_back(match->cell);
        mesh.facets.boundary.push_back(boundary);
      }
    }
    if (lost > 0 && named.strict)
      fail(options.file, fmt::format("boundary \"{}\" has {} facets that lie on no cell of any body", named.name, lost));
    if (taken.empty() && !curved_surface(named.name))
      assembly.warnings.push_back(
          inside > 0 && named.strict
              ? fmt::format("boundary \"{}\" lies between two volumes of one body; it is empty", named.name)
              : fmt::format("boundary \"{}\" of the mesh is empty", named.name));
  }
}

// Node sets in the numbers of the bodies' nodes.
void attach_node_sets(const RawMesh& raw, const std::vector<Local>& original, Assembly& assembly)
{
  if (raw.node_sets.empty()) return;
  std::vector<std::vector<Global>> copies(raw.points.size());  // of each node of the file, one for each body
  for (std::size_t n = 0; n < original.size(); ++n)
    copies[static_cast<std::size_t>(original[n])].push_back(assembly.mesh.node_id[n]);
  for (const auto& set : raw.node_sets) {
    std::map<Global, double> weights;
    for (std::size_t i = 0; i < set.nodes.size(); ++i)
      for (const Global node : copies[static_cast<std::size_t>(set.nodes[i])]) weights[node] += set.weights[i];
    auto& found = assembly.catalogue.node_sets.emplace_back();
    found.name = set.name;
    for (const auto& [node, weight] : weights) found.nodes.push_back(node), found.weights.push_back(weight);
  }
}

}  // namespace

void flatten(const std::string& file, std::vector<Point>& points)
{
  double extent = 0;
  for (const auto& point : points) extent = std::max(extent, point.head<2>().cwiseAbs().maxCoeff());
  for (auto& point : points) {
    if (std::abs(point[2]) > 1e-9 * extent)
      fail(file, "a plane model must lie in z = 0, but a node has z = " + std::to_string(point[2]));
    point[2] = 0;
  }
}

Assembly assemble(RawMesh raw, const Options& options, int dimension)
{
  check(raw, options.file);
  resolve_repeated_nodes(raw, options.file, dimension);
  orient(raw, options, dimension);
  const Groups groups = group(raw, options);
  const auto faces = sorted_faces(raw.cells);
  require_conforming(options.file, raw, faces, groups, dimension);
  const auto part =
      parts_of(face_neighbours(faces, raw.cells.size()), groups, close_surfaces(raw, groups.label, options.file, dimension));
  std::vector<Local> original;
  std::vector<int> solid_of_cell;
  Assembly assembly = separate(raw, groups, part, options, dimension, original, solid_of_cell);
  assembly.warnings.insert(assembly.warnings.begin(), raw.warnings.begin(), raw.warnings.end());
  attach_boundaries(raw, options, original, solid_of_cell, assembly);
  attach_node_sets(raw, original, assembly);
  return assembly;
}

}  // namespace mortise::mesh
