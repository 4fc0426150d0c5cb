#include "mesh/topology.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace mortise::mesh {

std::array<Local, 4> face_key(std::span<const Local> corners)
{
  std::array<Local, 4> key{-1, -1, -1, -1};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    std::size_t at = i;
    for (; at > 0 && key[at - 1] > corners[i]; --at) key[at] = key[at - 1];
    key[at] = corners[i];
  }
  return key;
}

namespace {

// Each face of each cell.
template <class Take>
void for_each_face(const Cells& cells, const Take& take)
{
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto nodes = cells[c];
    const auto& table = faces(cells.type[c]);
    for (std::size_t f = 0; f < table.size(); ++f) {
      std::array<Local, 4> corners;
      const auto count = static_cast<std::size_t>(corner_count(table[f].type));
      for (std::size_t i = 0; i < count; ++i) corners[i] = nodes[static_cast<std::size_t>(table[f].nodes[i])];
      take(CellFace{face_key(std::span(corners).first(count)), static_cast<Local>(c), static_cast<int>(f)});
    }
  }
}

}  // namespace

// Counted by their first corner: a node has a few dozen faces, which are sorted in no time.
std::vector<CellFace> sorted_faces(const Cells& cells)
{
  Local last = -1;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const Local node : cells[c]) last = std::max(last, node);
  std::vector<std::size_t> end(static_cast<std::size_t>(last) + 2, 0);
  for_each_face(cells, [&](const CellFace& face) { ++end[static_cast<std::size_t>(face.corners[0]) + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<CellFace> result(end.back());
  for_each_face(cells, [&](const CellFace& face) { result[end[static_cast<std::size_t>(face.corners[0])]++] = face; });
  for (std::size_t node = 0; node + 1 < end.size(); ++node) {  // of which end is the end by now
    const auto at = [&](std::size_t i) { return result.begin() + static_cast<std::ptrdiff_t>(i); };
    std::sort(at(node == 0 ? 0 : end[node - 1]), at(end[node]),
              [](const CellFace& a, const CellFace& b) { return std::tie(a.corners, a.cell) < std::tie(b.corners, b.cell); });
  }
  return result;
}

std::vector<CellFace> border_faces(const Cells& cells)
{
  const auto all = sorted_faces(cells);
  std::vector<CellFace> result;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].corners == all[i].corners) ++end;
    if (end == i + 1) result.push_back(all[i]);
    i = end;
  }
  return result;
}

Neighbours face_neighbours(const Cells& cells)
{
  return face_neighbours(sorted_faces(cells), cells.size());
}

Neighbours face_neighbours(std::span<const CellFace> faces, std::size_t cells)
{
  const auto for_each_pair = [&](const auto& take) {
    for (std::size_t i = 0; i + 1 < faces.size(); ++i)
      if (faces[i].corners == faces[i + 1].corners) {
        take(faces[i].cell, faces[i + 1].cell);
        take(faces[i + 1].cell, faces[i].cell);
      }
  };
  Neighbours result;
  result.offset.assign(cells + 1, 0);
  for_each_pair([&](Local cell, Local) { ++result.offset[static_cast<std::size_t>(cell) + 1]; });
  std::partial_sum(result.offset.begin(), result.offset.end(), result.offset.begin());
  result.cells.resize(static_cast<std::size_t>(result.offset.back()));
  auto next = result.offset;
  for_each_pair([&](Local cell, Local other) {
    result.cells[static_cast<std::size_t>(next[static_cast<std::size_t>(cell)]++)] = other;
  });
  for (std::size_t c = 0; c < cells; ++c)
    std::sort(result.cells.begin() + result.offset[c], result.cells.begin() + result.offset[c + 1]);
  return result;
}

std::vector<int> connected_parts(const Neighbours& neighbours, const std::vector<int>& label)
{
  std::vector<int> part(label.size(), -1);
  std::vector<Local> stack;
  int count = 0;
  for (std::size_t seed = 0; seed < label.size(); ++seed) {
    if (part[seed] >= 0) continue;
    part[seed] = count;
    stack.push_back(static_cast<Local>(seed));
    while (!stack.empty()) {
      const auto cell = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      for (const Local other : neighbours[cell]) {
        const auto o = static_cast<std::size_t>(other);
        if (part[o] >= 0 || label[o] != label[cell]) continue;
        part[o] = count;
        stack.push_back(other);
      }
    }
    ++count;
  }
  return part;
}

Mesh submesh(const Mesh& mesh, std::span<const Local> cells)
{
  std::vector<Local> nodes;
  for (const Local c : cells)
    nodes.insert(nodes.end(), mesh.cells[static_cast<std::size_t>(c)].begin(), mesh.cells[static_cast<std::size_t>(c)].end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto local = [&](Local n) { return static_cast<Local>(std::lower_bound(nodes.begin(), nodes.end(), n) - nodes.begin()); };

  Mesh result;
  for (const Local n : nodes) {
    result.node_id.push_back(mesh.node_id[static_cast<std::size_t>(n)]);
    result.points.push_back(mesh.points[static_cast<std::size_t>(n)]);
  }
  const auto add = [&](Cells& to, CellType type, std::span<const Local> from) {
    std::vector<Local> renumbered;
    for (const Local n : from) renumbered.push_back(local(n));
    to.add(type, renumbered);
  };
  for (const Local c : cells) {
    const auto i = static_cast<std::size_t>(c);
    add(result.cells, mesh.cells.type[i], mesh.cells[i]);
    result.cell_id.push_back(mesh.cell_id[i]);
    result.cell_body.push_back(mesh.cell_body[i]);
    if (!mesh.cell_volume.empty()) result.cell_volume.push_back(mesh.cell_volume[i]);
  }
  for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
    const auto parent = std::lower_bound(cells.begin(), cells.end(), mesh.facets.parent[f]);
    if (parent == cells.end() || *parent != mesh.facets.parent[f]) continue;
    add(result.facets.cells, mesh.facets.cells.type[f], mesh.facets.cells[f]);
    result.facets.parent.push_back(static_cast<Local>(parent - cells.begin()));
    result.facets.boundary.push_back(mesh.facets.boundary[f]);
  }
  return result;
}

}  // namespace mortise::mesh
