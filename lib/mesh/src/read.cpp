#include "mesh/read.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <unordered_map>

#include "deck/document.hpp"
#include "file_kind.hpp"
#include "gmsh_file.hpp"
#include "gmsh_library.hpp"
#include "mesh/curved_surface.hpp"
#include "mesh/topology.hpp"
#include "raw_mesh.hpp"

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
  library().getPhysicalGroups(list, dimension);
  for (const auto& [dim, tag] : list) {
    Group group;
    library().getPhysicalName(dim, tag, group.name);
    if (group.name.empty()) group.name = std::to_string(tag);
    library().getEntitiesForPhysicalGroup(dim, tag, group.entities);
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
  library().getElementProperties(gmsh_type, name, dimension, order, nodes, coordinates, primary);
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
  library().getElements(types, tags, nodes, dimension, entity);
  for (std::size_t t = 0; t < types.size(); ++t) {
    const CellType type = cell_type(file, types[t]);
    const auto count = static_cast<std::size_t>(node_count(type));
    for (std::size_t e = 0; e < tags[t].size(); ++e)
      visit(type, tags[t][e], std::span<const std::size_t>(nodes[t]).subspan(e * count, count));
  }
}

// The nodes of the file under local numbers.
struct NumberedNodes {
  std::unordered_map<std::size_t, Local> local;
  std::vector<Point> points;

  Local of(const std::string& file, std::size_t element, std::size_t tag) const
  {
    const auto found = local.find(tag);
    if (found == local.end()) fail(file, fmt::format("element {} has the node {}, which does not exist", element, tag));
    return found->second;
  }
};

NumberedNodes read_nodes(const Options& options, int dimension)
{
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  library().getNodes(tags, coordinates, parameters, -1, -1, false, true);
  if (tags.empty()) fail(options.file, "holds no mesh");
  std::vector<std::size_t> order(tags.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  NumberedNodes nodes;
  for (const std::size_t i : order) {
    nodes.local.emplace(tags[i], static_cast<Local>(nodes.points.size()));
    const Point x(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
    if (!x.allFinite())
      fail(options.file, fmt::format("node {} has the coordinates \"{} {} {}\"; expected numbers", tags[i], x[0], x[1], x[2]));
    nodes.points.push_back(options.scale * x);
  }
  if (dimension == 2) flatten(options.file, nodes.points);
  return nodes;
}

// A body that has no cells of its own, by the entities that enclose it.
struct Shell {
  int volume;  // index into RawMesh::volumes
  int solid;   // of a CAD file, or -1
  std::vector<int> entities;
};

bool has_cells(int dimension, const Group& group)
{
  return std::any_of(group.entities.begin(), group.entities.end(), [&](int entity) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    library().getElements(types, tags, nodes, dimension, entity);
    return !types.empty();
  });
}

std::vector<int> border_of(int dimension, const std::vector<int>& entities)
{
  gmsh::vectorpair solids, border;
  for (const int entity : entities) solids.emplace_back(dimension, entity);
  library().getBoundary(solids, border, true, false, false);
  std::vector<int> result;
  for (const auto& [dim, entity] : border) result.push_back(std::abs(entity));
  return result;
}

const Group* find(const std::vector<Group>& groups, const std::string& name)
{
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.name == name; });
  return found == groups.end() ? nullptr : &*found;
}

std::vector<int> entities_of(const Options& options, const std::vector<Group>& sides, const std::string& body,
                             const std::vector<std::string>& surfaces)
{
  std::vector<int> result;
  std::vector<std::string> known;
  for (const auto& side : sides)
    if (!curved_surface(side.name)) known.push_back(side.name);
  for (const auto& name : surfaces) {
    const auto* side = find(sides, name);
    if (side == nullptr)
      fail(options.file,
           fmt::format("body \"{}\": there is no physical surface \"{}\"{}", body, name, deck::suggestion(name, known)));
    for (const int entity : side->entities)
      if (std::find(result.begin(), result.end(), entity) == result.end()) result.push_back(entity);
  }
  return result;
}

// The bodies of options.surfaces: physical surfaces, or volumes that have none but the cells of their surface.
std::vector<Shell> shells(const Options& options, int dimension, const std::vector<Group>& bodies, RawMesh& raw)
{
  std::vector<Shell> result;
  const auto sides = groups(dimension - 1);
  for (const auto& [name, surfaces] : options.surfaces) {
    const auto* body = find(bodies, name);
    const bool meshed = body != nullptr && has_cells(dimension, *body);
    if (meshed && !surfaces.empty())
      fail(options.file,
           fmt::format("has cells of the body \"{}\" as well as its `surfaces`; leave these out, or give the body another "
                       "name",
                       name));
    if (meshed) continue;
    if (body != nullptr && surfaces.empty()) {
      const auto volume = static_cast<int>(body - bodies.data());
      if (!is_cad(kind_of(options.file)))
        result.push_back({volume, -1, border_of(dimension, body->entities)});
      else
        for (const int solid : body->entities) result.push_back({volume, solid, border_of(dimension, {solid})});
      continue;
    }
    if (surfaces.empty() && find(sides, name) == nullptr) continue;  // the deck's check of names knows more
    result.push_back({static_cast<int>(raw.volumes.size()), -1,
                      entities_of(options, sides, name, surfaces.empty() ? std::vector{name} : surfaces)});
    raw.volumes.push_back(name);
  }
  return result;
}

void add_cells(const Options& options, int dimension, int entity, int volume, int solid, const NumberedNodes& nodes, RawMesh& raw)
{
  for_each_element(options.file, dimension, entity, [&](CellType type, std::size_t tag, std::span<const std::size_t> tags) {
    if (volume < 0)
      fail(options.file, fmt::format("element {} lies in entity {}, which belongs to no physical {}; add the entity to a body{}",
                                     tag, entity, dimension == 3 ? "volume" : "surface",
                                     options.surfaces.empty() ? "" : ", or all of its sides to the `surfaces` of one"));
    std::vector<Local> cell;
    for (const std::size_t t : tags) cell.push_back(nodes.of(options.file, tag, t));
    raw.cells.add(type, cell);
    raw.tag.push_back(tag);
    raw.volume.push_back(volume);
    if (solid >= 0) raw.solid.push_back(solid);
  });
}

void read_cells(const Options& options, int dimension, const std::vector<Group>& bodies, const NumberedNodes& nodes, RawMesh& raw)
{
  const auto enclosed = shells(options, dimension, bodies, raw);
  const bool solids = is_cad(kind_of(options.file));
  if (raw.volumes.empty() && solids)
    fail(options.file, fmt::format("holds no {}", dimension == 3 ? "solid: its surfaces enclose no volume that is a body"
                                                                 : "face that could be a body"));
  if (raw.volumes.empty())
    fail(options.file,
         fmt::format("has no physical {0}; give each body a name with gmsh's Physical {1}(\"name\") = {{...}};{2}",
                     dimension == 3 ? "volume" : "surface", dimension == 3 ? "Volume" : "Surface",
                     dimension == 3 ? " a closed physical surface is a body where `bodies` has an entry of its name with "
                                      "`method: boundary_elements`"
                                    : ""));
  std::map<int, int> owner;
  for (std::size_t g = 0; g < bodies.size(); ++g)
    for (const int entity : bodies[g].entities)
      if (const auto [at, fresh] = owner.emplace(entity, static_cast<int>(g)); !fresh)
        fail(options.file, fmt::format("entity {} belongs to two bodies, \"{}\" and \"{}\"", entity,
                                       bodies[static_cast<std::size_t>(at->second)].name, bodies[g].name));
  gmsh::vectorpair entities;
  library().getEntities(entities, dimension);
  for (const auto& [dim, entity] : entities) {
    const auto body = owner.find(entity);
    add_cells(options, dimension, entity, body == owner.end() ? -1 : body->second, solids ? entity : -1, nodes, raw);
  }
  for (const auto& shell : enclosed)
    for (const int entity : shell.entities) add_cells(options, dimension - 1, entity, shell.volume, shell.solid, nodes, raw);
  if (!raw.volume.empty()) return;
  std::vector<std::string> known;
  for (const auto& list : {bodies, groups(dimension - 1)})
    for (const auto& group : list)
      if (!curved_surface(group.name)) known.push_back(group.name);
  if (options.surfaces.empty() || known.empty()) fail(options.file, "its physical groups hold no cells of the model's dimension");
  fail(options.file, fmt::format("has no cells of \"{}\", nor a closed surface; what it has names: {}",
                                 options.surfaces.begin()->first, fmt::join(known, ", ")));
}

// Lines, which gmsh keeps no count of. Asked for by a type, it gives as many as there are in the entity.
void require_whole_curve(const std::string& file, int entity)
{
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  library().getElements(types, tags, nodes, 1, entity);
  std::size_t given = 0, there = 0;
  for (std::size_t t = 0; t < types.size(); ++t) {
    std::vector<std::size_t> all, their_nodes;
    library().getElementsByType(types[t], all, their_nodes, entity, 0, 1);
    given += tags[t].size();
    there += all.size();
  }
  if (there > given)
    fail(file, fmt::format("{} of {} lines of the curve {} stand in it with lines of another order, where gmsh does not give them: "
                           "write lines of first and of second order into entities of their own",
                           there - given, there, entity));
}

// gmsh gives of each shape in an entity the cells of one order alone, and says nothing of the others.
void require_whole(const std::string& file, int dimension)
{
  std::map<CellType, double> given;
  gmsh::vectorpair entities;
  library().getEntities(entities, -1);
  for (const auto& [dim, entity] : entities) {
    if (dim == 1) require_whole_curve(file, entity);
    if (dim < 2 || dim > dimension) continue;
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    library().getElements(types, tags, nodes, dim, entity);
    for (std::size_t t = 0; t < types.size(); ++t)
      given[first_order(cell_type(file, types[t]))] += static_cast<double>(tags[t].size());
  }
  for (const auto& [shape, counter] : {std::pair(CellType::tri3, "Mesh.NbTriangles"),
                                       {CellType::quad4, "Mesh.NbQuadrangles"},
                                       {CellType::tet4, "Mesh.NbTetrahedra"},
                                       {CellType::hex8, "Mesh.NbHexahedra"},
                                       {CellType::prism6, "Mesh.NbPrisms"}}) {
    if (mesh::dimension(shape) > dimension) continue;
    double there = 0;
    library().getNumber(counter, there);
    if (there != given[shape])
      fail(file, fmt::format(
                     "{:.0f} of {:.0f} cells of the shape of {} stand in one entity with cells of another order, where gmsh does "
                     "not give them: write cells of first and of second order into entities of their own",
                     there - given[shape], there, name(shape)));
  }
}

// The faces of an entity.
void add_faces(const Options& options, int dimension, int entity, const NumberedNodes& nodes, RawMesh::Boundary& boundary)
{
  for_each_element(options.file, dimension, entity, [&](CellType type, std::size_t tag, std::span<const std::size_t> tags) {
    std::vector<Local> corners;
    for (const std::size_t t : tags.first(static_cast<std::size_t>(corner_count(type))))
      corners.push_back(nodes.of(options.file, tag, t));
    boundary.faces.push_back(face_key(corners));
  });
}

// Every face of every solid of a CAD file: solid.face.1, solid.face.2, ..; in plane models every edge of every face.
void add_cad_faces(const Options& options, int dimension, const std::vector<Group>& bodies, const NumberedNodes& nodes,
                   RawMesh& raw)
{
  for (const auto& body : bodies)
    for (std::size_t i = 0; i < body.entities.size(); ++i) {
      const auto solid = body.entities.size() == 1 ? body.name : fmt::format("{}.{}", body.name, i + 1);
      std::vector<int> above, faces;
      library().getAdjacencies(dimension, body.entities[i], above, faces);
      std::sort(faces.begin(), faces.end());
      faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
      for (std::size_t k = 0; k < faces.size(); ++k) {
        RawMesh::Boundary boundary{
            fmt::format("{}.{}.{}", solid, dimension == 3 ? "face" : "edge", k + 1), body.entities[i], {}, false};
        add_faces(options, dimension - 1, faces[k], nodes, boundary);
        raw.boundaries.push_back(std::move(boundary));
      }
    }
}

// Physical points, each with the weight 1.
void add_points(const NumberedNodes& nodes, RawMesh& raw)
{
  for (const auto& group : groups(0)) {
    RawMesh::NodeSet set{group.name, {}, {}};
    for (const int entity : group.entities) {
      std::vector<std::size_t> tags;
      std::vector<double> coordinates, parameters;
      library().getNodes(tags, coordinates, parameters, 0, entity, false, false);
      for (const std::size_t tag : tags)
        if (const auto found = nodes.local.find(tag); found != nodes.local.end()) set.nodes.push_back(found->second);
    }
    set.weights.assign(set.nodes.size(), 1.0);
    raw.node_sets.push_back(std::move(set));
  }
}

// Physical curves in space: each node has the length that its shape functions integrate to on straight edges.
void add_curves(const Options& options, const NumberedNodes& nodes, RawMesh& raw)
{
  for (const auto& group : groups(1)) {
    RawMesh::NodeSet set{group.name, {}, {}};
    for (const int entity : group.entities)
      for_each_element(options.file, 1, entity, [&](CellType type, std::size_t tag, std::span<const std::size_t> tags) {
        std::vector<Local> line;
        for (const std::size_t t : tags) line.push_back(nodes.of(options.file, tag, t));
        const auto at = [&](std::size_t i) { return nodes.points[static_cast<std::size_t>(line[i])]; };
        const double length = (at(1) - at(0)).norm();
        set.nodes.insert(set.nodes.end(), line.begin(), line.end());
        if (type == CellType::line2)
          set.weights.insert(set.weights.end(), {length / 2, length / 2});
        else
          set.weights.insert(set.weights.end(), {length / 6, length / 6, 2 * length / 3});
      });
    raw.node_sets.push_back(std::move(set));
  }
}

}  // namespace

RawMesh take_from_gmsh(const Options& options, int dimension)
{
  const auto bodies = groups(dimension);
  NumberedNodes nodes = read_nodes(options, dimension);
  RawMesh raw;
  if (!is_cad(kind_of(options.file))) require_whole(options.file, dimension);
  for (const auto& body : bodies) raw.volumes.push_back(body.name);
  read_cells(options, dimension, bodies, nodes, raw);
  for (const auto& group : groups(dimension - 1)) {
    RawMesh::Boundary boundary{group.name, -1, {}, true};
    if (const auto surface = curved_surface(group.name)) boundary = {name_of(scaled(*surface, options.scale)), -1, {}, false};
    for (const int entity : group.entities) add_faces(options, dimension - 1, entity, nodes, boundary);
    raw.boundaries.push_back(std::move(boundary));
  }
  if (is_cad(kind_of(options.file))) add_cad_faces(options, dimension, bodies, nodes, raw);
  if (dimension == 3) add_curves(options, nodes, raw);
  add_points(nodes, raw);
  raw.points = std::move(nodes.points);
  return raw;
}

Assembly read(const Options& options, int dimension)
{
  check_file(options.file);
  const bool abaqus = kind_of(options.file) == FileKind::abaqus;
  return assemble(abaqus ? read_abaqus(options, dimension) : read_gmsh(options, dimension), options, dimension);
}

}  // namespace mortise::mesh
