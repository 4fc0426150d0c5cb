#include "partition/skin.hpp"

#include <algorithm>
#include <array>

#include "base/packed.hpp"
#include "mesh/topology.hpp"

namespace mortise::partition {

namespace {

struct OuterFace {
  std::array<Global, 4> corners;  // ascending, over all ranks
  Local subdomain, cell;
  int face;
};

// The faces of one subdomain that belong to one cell of it; of a skin its panels.
std::vector<mesh::CellFace> border_of(const Subdomain& subdomain)
{
  const auto& cells = subdomain.mesh.cells;
  if (!subdomain.skin) return mesh::border_faces(cells);
  std::vector<mesh::CellFace> panels;
  for (std::size_t c = 0; c < cells.size(); ++c) panels.push_back({mesh::face_key(cells[c]), static_cast<Local>(c), 0});
  return panels;
}

void add_border(const Subdomain& subdomain, Local index, std::vector<OuterFace>& border)
{
  for (const auto& own : border_of(subdomain)) {
    OuterFace face{{-1, -1, -1, -1}, index, own.cell, own.face};
    for (std::size_t k = 0; k < 4; ++k)
      if (own.corners[k] >= 0) face.corners[k] = subdomain.mesh.node_id[static_cast<std::size_t>(own.corners[k])];
    border.push_back(face);  // node_id ascends, and so do the corners
  }
}

// Which of the faces belong to no cell of another subdomain: those that a rank, chosen by a corner, is told of once. Collective.
std::vector<bool> told_once(const std::vector<OuterFace>& border, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Global>> corners(ranks);    // four of each face that a rank is told of
  std::vector<std::vector<std::size_t>> told(ranks);  // these faces
  for (std::size_t i = 0; i < border.size(); ++i) {
    const auto r = static_cast<std::size_t>(border[i].corners[0]) % ranks;
    corners[r].insert(corners[r].end(), border[i].corners.begin(), border[i].corners.end());
    told[r].push_back(i);
  }
  std::vector<std::vector<char>> send(ranks);
  PackedWriter writer;
  for (std::size_t r = 0; r < ranks; ++r)
    if (!corners[r].empty()) {
      writer.integers(corners[r]);
      send[r] = writer.take();
    }
  struct Received {
    std::array<Global, 4> corners;
    std::size_t from;
    int number;  // among those from there
  };
  std::vector<Received> all;
  const auto received = comm.exchange(send);
  for (std::size_t r = 0; r < ranks; ++r)
    if (!received[r].empty()) {
      const auto four = PackedReader(received[r]).integers();
      for (std::size_t i = 0; i < four.size(); i += 4)
        all.push_back({{four[i], four[i + 1], four[i + 2], four[i + 3]}, r, static_cast<int>(i / 4)});
    }
  std::sort(all.begin(), all.end(), [](const Received& a, const Received& b) { return a.corners < b.corners; });
  std::vector<std::vector<int>> answer(ranks);
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].corners == all[i].corners) ++end;
    if (end == i + 1) answer[all[i].from].push_back(all[i].number);
    i = end;
  }
  std::vector<bool> once(border.size(), false);
  const auto answers = comm.exchange(answer);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const int number : answers[r]) once[told[r][static_cast<std::size_t>(number)]] = true;
  return once;
}

}  // namespace

FaceOfCell face_of(const Subdomain& subdomain, Local cell, int face)
{
  const auto c = static_cast<std::size_t>(cell);
  const auto& cells = subdomain.mesh.cells;
  if (subdomain.skin) return {cells.type[c], {cells[c].begin(), cells[c].end()}};
  const auto& own = mesh::faces(cells.type[c])[static_cast<std::size_t>(face)];
  FaceOfCell result{own.type, {}};
  for (const int k : own.nodes) result.nodes.push_back(cells[c][static_cast<std::size_t>(k)]);
  return result;
}

Global face_number(const mesh::Mesh& mesh, std::size_t facet)
{
  const auto parent = static_cast<std::size_t>(mesh.facets.parent[facet]);
  const auto cell = mesh.cells[parent];
  const auto nodes = mesh.facets.cells[facet];
  const auto type = mesh.cells.type[parent];
  Local place = 0;
  if (mesh::dimension(type) == mesh::dimension(mesh.facets.cells.type[facet])) return 6 * mesh.cell_id[parent];  // a panel
  const auto& table = mesh::faces(type);
  for (std::size_t k = 0; k < table.size(); ++k)
    if (cell[static_cast<std::size_t>(table[k].nodes[0])] == nodes[0] &&
        cell[static_cast<std::size_t>(table[k].nodes[1])] == nodes[1])
      place = static_cast<Local>(k);
  return 6 * mesh.cell_id[parent] + place;
}

mesh::Surface outer_surface(const Decomposition& decomposition, const Communicator& comm)
{
  std::vector<OuterFace> border;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
    add_border(decomposition.subdomains[s], static_cast<Local>(s), border);
  const auto once = told_once(border, comm);
  mesh::Surface surface;
  const auto nodes_of = [&](const OuterFace& face, const auto& use) {
    const auto& subdomain = decomposition.subdomains[static_cast<std::size_t>(face.subdomain)];
    const auto& mesh = subdomain.mesh;
    for (const Local n : face_of(subdomain, face.cell, face.face).nodes) use(mesh, static_cast<std::size_t>(n));
  };
  for (std::size_t i = 0; i < border.size(); ++i)
    if (once[i])
      nodes_of(border[i], [&](const mesh::Mesh& mesh, std::size_t node) { surface.node_id.push_back(mesh.node_id[node]); });
  std::sort(surface.node_id.begin(), surface.node_id.end());
  surface.node_id.erase(std::unique(surface.node_id.begin(), surface.node_id.end()), surface.node_id.end());
  surface.points.resize(surface.node_id.size());
  for (std::size_t i = 0; i < border.size(); ++i) {
    if (!once[i]) continue;
    std::vector<Local> nodes;
    nodes_of(border[i], [&](const mesh::Mesh& mesh, std::size_t node) {
      const auto at =
          std::lower_bound(surface.node_id.begin(), surface.node_id.end(), mesh.node_id[node]) - surface.node_id.begin();
      nodes.push_back(static_cast<Local>(at));
      surface.points[static_cast<std::size_t>(at)] = mesh.points[node];
    });
    const auto& subdomain = decomposition.subdomains[static_cast<std::size_t>(border[i].subdomain)];
    surface.faces.add(face_of(subdomain, border[i].cell, border[i].face).type, nodes);
    surface.face_id.push_back(6 * subdomain.mesh.cell_id[static_cast<std::size_t>(border[i].cell)] + border[i].face);
    surface.body.push_back(subdomain.body);
  }
  return surface;
}

}  // namespace mortise::partition
