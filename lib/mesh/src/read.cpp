#include "mesh/read.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "gmsh_file.hpp"
#include "mesh/topology.hpp"

namespace mortise::mesh {

namespace {

// What gmsh holds for one physical group.
struct Group {
  std::string name;
  std::vector<int> entities;
};

std::vector<Group> groups(int dimension)
{
  std::vector<Group> result;
  gmsh::vectorpair list;
  gmsh::model::getPhysicalGroups(list, dimension);
  for (const auto& [dim, tag] : list) {
    Group group;
    gmsh::model::getPhysicalName(dim, tag, group.name);
    if (group.name.empty()) group.name = std::to_string(tag);
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, group.entities);
    result.push_back(std::move(group));
  }
  return result;
}

CellType cell_type(const std::string& file, int gmsh_type)
{
  using enum CellType;
  static const std::map<int, CellType> table{{1, line2},  {2, tri3},     {3, quad4},  {4, tet4},   {5, hex8},
                                             {6, prism6}, {8, line3},    {9, tri6},   {10, quad9}, {11, tet10},
                                             {12, hex27}, {13, prism18}, {16, quad8}, {17, hex20}, {18, prism15}};
  const auto found = table.find(gmsh_type);
  if (found != table.end()) return found->second;
  std::string name;
  int dimension = 0, order = 0, nodes = 0, primary = 0;
  std::vector<double> coordinates;
  gmsh::model::mesh::getElementProperties(gmsh_type, name, dimension, order, nodes, coordinates, primary);
  fail(file,
       fmt::format("has cells of type \"{}\"; known are lines, triangles, quadrilaterals, tetrahedra, hexahedra and prisms of "
                   "first and second order: mesh {}",
                   name, order > 2 ? "with order 2" : "without pyramids"));
}

// Calls visit(type, element tag, node tags) for each element of an entity.
template <class Visit>
void for_each_element(const std::string& file, int dimension, int entity, const Visit& visit)
{
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
  for (std::size_t t = 0; t < types.size(); ++t) {
    const CellType type = cell_type(file, types[t]);
    const auto count = static_cast<std::size_t>(node_count(type));
    for (std::size_t e = 0; e < tags[t].size(); ++e)
      visit(type, tags[t][e], std::span<const std::size_t>(nodes[t]).subspan(e * count, count));
  }
}

// The nodes of the file under local numbers.
struct Nodes {
  std::unordered_map<std::size_t, Local> local;
  std::vector<Point> points;
};

Nodes read_nodes(const Options& options, int dimension)
{
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  if (tags.empty()) fail(options.file, "holds no mesh");
  std::vector<std::size_t> order(tags.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  Nodes nodes;
  double extent = 0;
  for (const std::size_t i : order) {
    nodes.local.emplace(tags[i], static_cast<Local>(nodes.points.size()));
    nodes.points.push_back(options.scale * Point(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]));
    extent = std::max(extent, nodes.points.back().head<2>().cwiseAbs().maxCoeff());
  }
  if (dimension == 2)
    for (auto& point : nodes.points) {
      if (std::abs(point[2]) > 1e-9 * extent)
        fail(options.file, "a plane model must lie in z = 0, but a node has z = " + std::to_string(point[2]));
      point[2] = 0;
    }
  return nodes;
}

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
std::vector<int> turned_corners(CellType first_order)
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
    default:
      return {0, 1};
  }
}

// The same cell, turned inside out.
std::vector<Local> turned(CellType type, std::span<const Local> nodes)
{
  const auto corner = turned_corners(first_order(type));
  std::vector<Local> result;
  for (const int c : corner) result.push_back(nodes[static_cast<std::size_t>(c)]);
  for (const auto& amid : middles(type)) {
    std::vector<int> old;
    for (const int c : amid) old.push_back(corner[static_cast<std::size_t>(c)]);
    result.push_back(nodes[static_cast<std::size_t>(node_amid(type, old))]);
  }
  return result;
}

// Cells in the nodes of the file, with the group of each.
struct RawCells {
  Cells cells;
  std::vector<int> group;
};

RawCells read_cells(const Options& options, int dimension, const std::vector<Group>& bodies, const Nodes& nodes)
{
  if (bodies.empty())
    fail(options.file, fmt::format("has no physical {0}; give each body a name with gmsh's Physical {1}(\"name\") = {{...}};",
                                   dimension == 3 ? "volume" : "surface", dimension == 3 ? "Volume" : "Surface"));
  std::map<int, int> owner;
  for (std::size_t g = 0; g < bodies.size(); ++g)
    for (const int entity : bodies[g].entities)
      if (const auto [at, fresh] = owner.emplace(entity, static_cast<int>(g)); !fresh)
        fail(options.file, fmt::format("entity {} belongs to two bodies, \"{}\" and \"{}\"", entity,
                                       bodies[static_cast<std::size_t>(at->second)].name, bodies[g].name));
  RawCells raw;
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, dimension);
  for (const auto& [dim, entity] : entities) {
    const auto body = owner.find(entity);
    for_each_element(options.file, dimension, entity, [&](CellType type, std::size_t tag, std::span<const std::size_t> tags) {
      if (body == owner.end())
        fail(options.file, fmt::format("element {} lies in entity {}, which belongs to no physical {}; add the entity to a body",
                                       tag, entity, dimension == 3 ? "volume" : "surface"));
      std::vector<Local> cell;
      for (const std::size_t t : tags) cell.push_back(nodes.local.at(t));
      const double volume = orientation(type, cell, nodes.points);
      Point low = nodes.points[static_cast<std::size_t>(cell[0])], high = low;
      for (const Local n : cell) {
        low = low.cwiseMin(nodes.points[static_cast<std::size_t>(n)]);
        high = high.cwiseMax(nodes.points[static_cast<std::size_t>(n)]);
      }
      if (std::abs(volume) <= 1e-12 * std::pow((high - low).maxCoeff(), dimension))
        fail(options.file, fmt::format("element {} ({}) of body \"{}\" has no volume; improve the mesh there", tag, name(type),
                                       bodies[static_cast<std::size_t>(body->second)].name));
      if (volume < 0) cell = turned(type, cell);
      raw.cells.add(type, cell);
      raw.group.push_back(body->second);
    });
  }
  if (raw.group.empty()) fail(options.file, "its physical groups hold no cells of the model's dimension");
  return raw;
}

// Two cells of one body must meet with the same kind of face: a node in the middle that only one of them has would tear them.
void require_conforming(const std::string& file, const RawCells& raw, const std::vector<Group>& bodies)
{
  const auto all = sorted_faces(raw.cells);
  const auto type_of = [&](const CellFace& face) {
    return faces(raw.cells.type[static_cast<std::size_t>(face.cell)])[static_cast<std::size_t>(face.face)].type;
  };
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].corners != all[i + 1].corners || type_of(all[i]) == type_of(all[i + 1])) continue;
    const int a = raw.group[static_cast<std::size_t>(all[i].cell)], b = raw.group[static_cast<std::size_t>(all[i + 1].cell)];
    if (a == b)
      fail(file,
           fmt::format("in body \"{}\" a face is a {} of one cell and a {} of its neighbour; mesh the whole body with one order "
                       "and one kind of elements (Mesh.SecondOrderIncomplete)",
                       bodies[static_cast<std::size_t>(a)].name, name(type_of(all[i])), name(type_of(all[i + 1]))));
  }
}

// Cells ordered by body, with nodes of its own for each body.
Assembly separate(const RawCells& raw, const std::vector<Group>& bodies, const Nodes& nodes, int dimension,
                  std::vector<Local>& original)
{
  const auto part = connected_parts(face_neighbours(raw.cells), raw.group);
  const int parts = 1 + *std::max_element(part.begin(), part.end());
  std::vector<int> group_of(static_cast<std::size_t>(parts)), parts_in(bodies.size(), 0), order(static_cast<std::size_t>(parts));
  for (std::size_t c = part.size(); c-- > 0;) group_of[static_cast<std::size_t>(part[c])] = raw.group[c];
  for (int p = 0; p < parts; ++p) order[static_cast<std::size_t>(p)] = p;
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return group_of[static_cast<std::size_t>(a)] < group_of[static_cast<std::size_t>(b)]; });
  for (const int g : group_of) ++parts_in[static_cast<std::size_t>(g)];

  Assembly assembly;
  assembly.catalogue.dimension = dimension;
  std::vector<std::vector<Local>> cells_of(static_cast<std::size_t>(parts));
  for (std::size_t c = 0; c < part.size(); ++c) cells_of[static_cast<std::size_t>(part[c])].push_back(static_cast<Local>(c));
  std::vector<int> numbered(bodies.size(), 0);
  Mesh& mesh = assembly.mesh;
  for (const int p : order) {
    const auto g = static_cast<std::size_t>(group_of[static_cast<std::size_t>(p)]);
    const auto& name = bodies[g].name;
    assembly.catalogue.bodies.push_back({parts_in[g] == 1 ? name : fmt::format("{}.{}", name, ++numbered[g]), name});
    const auto& cells = cells_of[static_cast<std::size_t>(p)];
    std::vector<Local> used;
    for (const Local c : cells)
      used.insert(used.end(), raw.cells[static_cast<std::size_t>(c)].begin(), raw.cells[static_cast<std::size_t>(c)].end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const auto base = static_cast<Local>(mesh.points.size());
    for (const Local n : used) {
      mesh.node_id.push_back(static_cast<Global>(mesh.points.size()));
      mesh.points.push_back(nodes.points[static_cast<std::size_t>(n)]);
      original.push_back(n);
    }
    for (const Local c : cells) {
      std::vector<Local> cell;
      for (const Local n : raw.cells[static_cast<std::size_t>(c)])
        cell.push_back(base + static_cast<Local>(std::lower_bound(used.begin(), used.end(), n) - used.begin()));
      mesh.cell_id.push_back(static_cast<Global>(mesh.cells.size()));
      mesh.cells.add(raw.cells.type[static_cast<std::size_t>(c)], cell);
      mesh.cell_body.push_back(static_cast<int>(assembly.catalogue.bodies.size()) - 1);
    }
  }
  // Parts of one body that share nodes, but no face, part there.
  std::map<std::pair<Local, int>, int> first_part;  // node of the file and group -> part
  std::map<int, std::size_t> torn;                  // group -> nodes
  for (std::size_t c = 0; c < raw.cells.size(); ++c)
    for (const Local n : raw.cells[c])
      if (const auto [at, fresh] = first_part.emplace(std::pair(n, raw.group[c]), part[c]); !fresh && at->second != part[c]) {
        ++torn[raw.group[c]];
        at->second = part[c];
      }
  for (const auto& [group, count] : torn)
    assembly.warnings.push_back(
        fmt::format("parts of body \"{}\" share an edge or a vertex and no face ({} nodes): they are separate bodies there, "
                    "which nothing ties; "
                    "give them a common face, or contacts",
                    bodies[static_cast<std::size_t>(group)].name, count));
  assembly.catalogue.node_count = static_cast<Global>(mesh.points.size());
  assembly.catalogue.cell_count = static_cast<Global>(mesh.cells.size());
  return assembly;
}

// Facets of the boundaries, found on the cells by the nodes of the file.
void attach_boundaries(const Options& options, int dimension, const Nodes& nodes, const std::vector<Local>& original,
                       Assembly& assembly)
{
  Mesh& mesh = assembly.mesh;
  Cells in_file = mesh.cells;
  for (auto& n : in_file.nodes) n = original[static_cast<std::size_t>(n)];
  const auto all = sorted_faces(in_file);
  for (const auto& group : groups(dimension - 1)) {
    const auto boundary = static_cast<int>(assembly.catalogue.boundaries.size());
    assembly.catalogue.boundaries.push_back(group.name);
    std::size_t lost = 0;
    std::set<std::pair<Local, int>> taken;  // files of version 2.2 repeat a face for each group that it is in
    for (const int entity : group.entities)
      for_each_element(options.file, dimension - 1, entity, [&](CellType type, std::size_t, std::span<const std::size_t> tags) {
        std::vector<Local> on;
        for (const std::size_t tag : tags.first(static_cast<std::size_t>(corner_count(type)))) on.push_back(nodes.local.at(tag));
        const CellFace wanted{face_key(on)};
        const auto range = std::equal_range(all.begin(), all.end(), wanted,
                                            [](const CellFace& a, const CellFace& b) { return a.corners < b.corners; });
        if (range.first == range.second) {
          ++lost;
          return;
        }
        const auto body = [&](const CellFace& face) { return mesh.cell_body[static_cast<std::size_t>(face.cell)]; };
        if (range.second - range.first == 2 && body(*range.first) == body(*(range.first + 1)))
          fail(
              options.file,
              fmt::format(
                  "boundary \"{}\" runs through the inside of body \"{}\"; only faces on the surface of a body can be a boundary",
                  group.name, assembly.catalogue.bodies[static_cast<std::size_t>(body(*range.first))].name));
        for (auto match = range.first; match != range.second; ++match) {
          if (!taken.emplace(match->cell, match->face).second) continue;
          const auto cell = static_cast<std::size_t>(match->cell);
          const auto& face = faces(mesh.cells.type[cell])[static_cast<std::size_t>(match->face)];
          std::vector<Local> facet;
          for (const int i : face.nodes) facet.push_back(mesh.cells[cell][static_cast<std::size_t>(i)]);
          mesh.facets.cells.add(face.type, facet);
          mesh.facets.parent.push_back(match->cell);
          mesh.facets.boundary.push_back(boundary);
        }
      });
    if (lost > 0)
      fail(options.file, fmt::format("boundary \"{}\" has {} facets that lie on no cell of any body", group.name, lost));
    if (taken.empty()) assembly.warnings.push_back(fmt::format("boundary \"{}\" of the mesh is empty", group.name));
  }
}

}  // namespace

Assembly read(const Options& options, int dimension)
{
  const MeshFile file(options, dimension);
  const GmshSession gmsh_session({});
  if (const auto error = gmsh_session.load(file.path(), dimension); !error.empty()) fail(options.file, "gmsh: " + error);
  const auto bodies = groups(dimension);
  const Nodes nodes = read_nodes(options, dimension);
  const RawCells raw = read_cells(options, dimension, bodies, nodes);
  require_conforming(options.file, raw, bodies);
  std::vector<Local> original;
  Assembly assembly = separate(raw, bodies, nodes, dimension, original);
  attach_boundaries(options, dimension, nodes, original, assembly);
  return assembly;
}

}  // namespace mortise::mesh
