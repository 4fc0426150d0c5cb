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

Submeshes::Submeshes(const Mesh& mesh) : mesh_(mesh), local_(mesh.points.size(), -1), first_facet_(mesh.cells.size() + 1, 0)
{
  const auto& parent = mesh.facets.parent;
  for (const Local p : parent) ++first_facet_[static_cast<std::size_t>(p) + 1];
  std::partial_sum(first_facet_.begin(), first_facet_.end(), first_facet_.begin());
  facet_.resize(parent.size());
  auto next = first_facet_;
  for (std::size_t f = 0; f < parent.size(); ++f) facet_[next[static_cast<std::size_t>(parent[f])]++] = f;
}

Mesh Submeshes::operator()(std::span<const Local> cells)
{
  std::vector<Local> nodes;
  for (const Local c : cells)
    for (const Local n : mesh_.cells[static_cast<std::size_t>(c)])
      if (auto& known = local_[static_cast<std::size_t>(n)]; known < 0) {
        known = 0;
        nodes.push_back(n);
      }
  std::sort(nodes.begin(), nodes.end());

  Mesh result;
  for (const Local n : nodes) {
    const auto i = static_cast<std::size_t>(n);
    local_[i] = static_cast<Local>(result.points.size());
    result.node_id.push_back(mesh_.node_id[i]);
    result.points.push_back(mesh_.points[i]);
  }
  std::vector<Local> renumbered;
  const auto add = [&](Cells& to, CellType type, std::span<const Local> from) {
    renumbered.clear();
    for (const Local n : from) renumbered.push_back(local_[static_cast<std::size_t>(n)]);
    to.add(type, renumbered);
  };
  std::vector<std::size_t> facets;
  for (const Local c : cells) {
    const auto i = static_cast<std::size_t>(c);
    add(result.cells, mesh_.cells.type[i], mesh_.cells[i]);
    result.cell_id.push_back(mesh_.cell_id[i]);
    result.cell_body.push_back(mesh_.cell_body[i]);
    if (!mesh_.cell_volume.empty()) result.cell_volume.push_back(mesh_.cell_volume[i]);
    for (auto f = first_facet_[i]; f < first_facet_[i + 1]; ++f) facets.push_back(facet_[f]);
  }
  std::sort(facets.begin(), facets.end());
  for (const auto f : facets) {
    const auto parent = std::lower_bound(cells.begin(), cells.end(), mesh_.facets.parent[f]);
    add(result.facets.cells, mesh_.facets.cells.type[f], mesh_.facets.cells[f]);
    result.facets.parent.push_back(static_cast<Local>(parent - cells.begin()));
    result.facets.boundary.push_back(mesh_.facets.boundary[f]);
  }
  for (const Local n : nodes) local_[static_cast<std::size_t>(n)] = -1;
  return result;
}

}  // namespace mortise::mesh
