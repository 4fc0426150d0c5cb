// Cells that name a node several times, as programs write a wedge as a brick or a triangle as a quadrilateral: what is left when
// the corners with one node fall together is told by its faces.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "gmsh_file.hpp"
#include "mesh/topology.hpp"
#include "raw_mesh.hpp"

namespace mortise::mesh {

namespace {

using enum CellType;
using Nodes = std::vector<Local>;

bool repeats(std::span<const Local> nodes)
{
  std::array<Local, 32> sorted{};
  const auto end = std::copy(nodes.begin(), nodes.end(), sorted.begin());
  std::sort(sorted.begin(), end);
  return std::adjacent_find(sorted.begin(), end) != end;
}

// A ring of corners without those that fall on the one before.
Nodes without_neighbours(const Nodes& ring)
{
  Nodes result;
  for (const Local n : ring)
    if (result.empty() || result.back() != n) result.push_back(n);
  while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  return result;
}

// The faces that are left of a cell; none if one of them is folded, or two are the same.
std::vector<Nodes> faces_left(CellType first_order, std::span<const Local> nodes)
{
  std::vector<Nodes> result;
  std::set<Nodes> sets;
  for (const auto& face : faces(first_order)) {
    Nodes ring;
    for (const int i : face.nodes) ring.push_back(nodes[static_cast<std::size_t>(i)]);
    ring = without_neighbours(ring);
    if (ring.size() < 3) continue;
    Nodes sorted = ring;
    std::sort(sorted.begin(), sorted.end());
    if (repeats(ring) || !sets.insert(sorted).second) return {};
    result.push_back(std::move(ring));
  }
  return result;
}

// The corner of a quadrilateral's ring next to `corner` that is not `other`.
Local neighbour(const Nodes& ring, Local corner, const Nodes& triangle)
{
  const auto n = ring.size();
  const auto at = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), corner) - ring.begin());
  const Local before = ring[(at + n - 1) % n], after = ring[(at + 1) % n];
  return std::find(triangle.begin(), triangle.end(), before) == triangle.end() ? before : after;
}

// The corners of a wedge with two of the faces as triangles; empty if the faces are not those of a wedge.
Nodes wedge(const std::vector<Nodes>& faces)
{
  std::vector<Nodes> triangles, quadrilaterals;
  for (const auto& face : faces) (face.size() == 3 ? triangles : quadrilaterals).push_back(face);
  const auto &low = triangles[0], &high = triangles[1];
  Nodes result = low;
  std::map<Local, std::set<Local>> above;
  for (const auto& ring : quadrilaterals) {
    int on_low = 0;
    for (const Local n : low)
      if (std::find(ring.begin(), ring.end(), n) != ring.end()) ++on_low, above[n].insert(neighbour(ring, n, low));
    if (on_low != 2) return {};
  }
  for (const Local n : low) {
    if (above[n].size() != 1) return {};
    result.push_back(*above[n].begin());
  }
  Nodes top(result.begin() + 3, result.end()), expected = high;
  std::sort(top.begin(), top.end());
  std::sort(expected.begin(), expected.end());
  return top == expected ? result : Nodes{};
}

struct Corners {
  CellType first_order;
  Nodes nodes;
};

// What the corners of a cell are when those with one node are one.
std::optional<Corners> left(CellType first_order, std::span<const Local> corners)
{
  if (first_order == quad4) {
    const auto ring = without_neighbours({corners.begin(), corners.end()});
    if (ring.size() == 3 && !repeats(ring)) return Corners{tri3, ring};
    return {};
  }
  if (first_order != hex8 && first_order != prism6) return {};
  const auto faces = faces_left(first_order, corners);
  const auto triangles = std::count_if(faces.begin(), faces.end(), [](const Nodes& face) { return face.size() == 3; });
  const auto quadrilaterals = static_cast<std::ptrdiff_t>(faces.size()) - triangles;
  const auto different = std::set<Local>(corners.begin(), corners.end()).size();
  if (different == 4 && triangles == 4 && quadrilaterals == 0) {
    Nodes nodes = faces[0];
    for (const Local n : faces[1])
      if (std::find(faces[0].begin(), faces[0].end(), n) == faces[0].end()) nodes.push_back(n);
    return Corners{tet4, nodes};
  }
  if (different == 6 && triangles == 2 && quadrilaterals == 3)
    if (auto nodes = wedge(faces); !nodes.empty()) return Corners{prism6, std::move(nodes)};
  return {};
}

CellType of_second_order(CellType old, CellType first_order)
{
  if (first_order == tri3) return tri6;
  if (first_order == tet4) return tet10;
  return old == hex27 || old == prism18 ? prism18 : prism15;
}

// The cell that is meant; empty if there is none.
std::optional<std::pair<CellType, Nodes>> meant(CellType type, std::span<const Local> nodes)
{
  const auto corners = nodes.first(static_cast<std::size_t>(corner_count(type)));
  if (!repeats(corners)) return {};
  const auto shape = left(first_order(type), corners);
  if (!shape) return {};
  if (type == first_order(type)) return std::pair(shape->first_order, shape->nodes);
  // A node amid corners stays amid what these have become.
  std::map<std::pair<std::size_t, std::set<Local>>, std::set<Local>> amid;
  for (std::size_t m = 0; m < middles(type).size(); ++m) {
    std::set<Local> of;
    for (const int c : middles(type)[m]) of.insert(nodes[static_cast<std::size_t>(c)]);
    amid[{middles(type)[m].size(), of}].insert(nodes[corners.size() + m]);
  }
  const auto result = of_second_order(type, shape->first_order);
  Nodes all = shape->nodes;
  for (const auto& middle : middles(result)) {
    std::set<Local> of;
    for (const int c : middle) of.insert(shape->nodes[static_cast<std::size_t>(c)]);
    const auto& found = amid[{middle.size(), of}];
    if (found.size() != 1) return {};
    all.push_back(*found.begin());
  }
  if (repeats(all)) return {};
  return std::pair(result, std::move(all));
}

// Keys of faces of which only an edge is left name no face.
void resolve(RawMesh::Boundary& boundary, std::size_t least)
{
  std::vector<std::array<Local, 4>> faces;
  for (const auto& key : boundary.faces) {
    Nodes nodes;
    for (const Local n : key)
      if (n >= 0 && (nodes.empty() || nodes.back() != n)) nodes.push_back(n);
    if (nodes.size() >= least) faces.push_back(face_key(nodes));
  }
  boundary.faces = std::move(faces);
}

}  // namespace

void resolve_repeated_nodes(RawMesh& raw, const std::string& file, int dimension)
{
  const auto& given = raw.cells;
  bool any = false;
  for (std::size_t c = 0; c < given.size() && !any; ++c) any = repeats(given[c]);
  for (auto& boundary : raw.boundaries) resolve(boundary, dimension == 3 ? 3 : 2);
  if (!any) return;
  Cells cells;
  for (std::size_t c = 0; c < given.size(); ++c) {
    if (!repeats(given[c])) {
      cells.add(given.type[c], given[c]);
      continue;
    }
    const auto cell = meant(given.type[c], given[c]);
    if (!cell) {
      const auto corners = given[c].first(static_cast<std::size_t>(corner_count(given.type[c])));
      const auto different = std::set<Local>(corners.begin(), corners.end()).size();
      fail(file,
           fmt::format("element {} ({}) of body \"{}\" names a node more than once, and what is left, {} corners{}, is no {}; "
                       "pyramids are not known",
                       raw.tag[c], name(given.type[c]), raw.volumes[static_cast<std::size_t>(raw.volume[c])], different,
                       given.type[c] == first_order(given.type[c]) ? "" : " and the nodes amid them",
                       dimension == 3 ? "tetrahedron or wedge" : "triangle"));
    }
    cells.add(cell->first, cell->second);
  }
  raw.cells = std::move(cells);
}

}  // namespace mortise::mesh
