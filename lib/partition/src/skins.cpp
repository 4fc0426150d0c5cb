#include "partition/skins.hpp"

#include <algorithm>
#include <array>

#include "mesh/topology.hpp"
#include "partition/skin.hpp"

namespace mortise::partition {

namespace {

using Panel = std::vector<Local>;

// A panel's key: its cell's number, the place of the face in the cell, the place of the panel in the face.
constexpr Global faces_a_cell = 6, panels_a_face = 8, keys_a_cell = faces_a_cell * panels_a_face;

// Two triangles, from both sides the same: the diagonal runs through the smallest number.
void cut_quadrilateral(const std::array<Local, 4>& n, std::vector<Panel>& panels)
{
  const auto k = static_cast<std::size_t>(std::min_element(n.begin(), n.end()) - n.begin());
  panels.push_back({n[k], n[(k + 1) % 4], n[(k + 2) % 4]});
  panels.push_back({n[k], n[(k + 2) % 4], n[(k + 3) % 4]});
}

// The panels of a face, turned as the face is.
std::vector<Panel> panels_of(mesh::CellType face, const std::vector<Local>& n)
{
  using enum mesh::CellType;
  std::vector<Panel> panels;
  const auto add = [&](std::initializer_list<std::size_t> places) {
    auto& panel = panels.emplace_back();
    for (const auto i : places) panel.push_back(n[i]);
  };
  switch (face) {
    case line3:
      add({0, 2}), add({2, 1});
      break;
    case quad4:
      cut_quadrilateral({n[0], n[1], n[2], n[3]}, panels);
      break;
    case tri6:
      add({0, 3, 5}), add({1, 4, 3}), add({2, 5, 4}), add({3, 4, 5});
      break;
    case quad8:
      add({0, 4, 7}), add({1, 5, 4}), add({2, 6, 5}), add({3, 7, 6});
      cut_quadrilateral({n[4], n[5], n[6], n[7]}, panels);
      break;
    case quad9:
      for (std::size_t k = 0; k < 4; ++k) add({k, 4 + k, 8}), add({4 + k, (k + 1) % 4, 8});
      break;
    default:  // line2, tri3
      panels.push_back(n);
  }
  return panels;
}

// `nodes` by their new local numbers.
void add(mesh::CellType type, std::span<const Local> nodes, const std::vector<Local>& place, mesh::Cells& to)
{
  Panel renumbered;
  for (const Local n : nodes) renumbered.push_back(place[static_cast<std::size_t>(n)]);
  to.add(type, renumbered);
}

// Whether the body stands in its file as its surface alone.
bool is_surface(const mesh::Mesh& mesh, int dimension)
{
  return mesh.cells.size() > 0 && mesh::dimension(mesh.cells.type[0]) < dimension;
}

// The faces of a solid that bound it, or the cells of what is a surface already, by cell and face.
class Border {
 public:
  Border(const mesh::Mesh& solid, int dimension) : solid_(solid), surface_(is_surface(solid, dimension))
  {
    if (surface_)
      for (std::size_t c = 0; c < solid.cells.size(); ++c) faces_.push_back({{}, static_cast<Local>(c), 0});
    else
      faces_ = mesh::border_faces(solid.cells);
    std::sort(faces_.begin(), faces_.end(),
              [](const auto& a, const auto& b) { return std::pair(a.cell, a.face) < std::pair(b.cell, b.face); });
  }

  const std::vector<mesh::CellFace>& faces() const { return faces_; }
  mesh::CellType type(const mesh::CellFace& face) const
  {
    const auto type = cell_type(face);
    return surface_ ? type : mesh::faces(type)[static_cast<std::size_t>(face.face)].type;
  }
  std::vector<Local> nodes(const mesh::CellFace& face) const
  {
    const auto all = solid_.cells[static_cast<std::size_t>(face.cell)];
    if (surface_) return std::vector<Local>(all.begin(), all.end());
    std::vector<Local> nodes;
    for (const int k : mesh::faces(cell_type(face))[static_cast<std::size_t>(face.face)].nodes)
      nodes.push_back(all[static_cast<std::size_t>(k)]);
    return nodes;
  }
  // Of each node of the solid.
  std::vector<bool> has_node() const
  {
    std::vector<bool> on(solid_.node_count(), false);
    for (const auto& face : faces_)
      for (const Local n : nodes(face)) on[static_cast<std::size_t>(n)] = true;
    return on;
  }
  // The place of a facet's face; boundaries are on the surface of their body, and so of the subdomain.
  std::size_t find(std::size_t facet) const
  {
    const Local cell = solid_.facets.parent[facet];
    const auto face =
        static_cast<int>(face_number(solid_, facet) - faces_a_cell * solid_.cell_id[static_cast<std::size_t>(cell)]);
    const auto at = std::lower_bound(faces_.begin(), faces_.end(), std::pair(cell, face),
                                     [](const auto& a, const auto& b) { return std::pair(a.cell, a.face) < b; });
    return static_cast<std::size_t>(at - faces_.begin());
  }

 private:
  mesh::CellType cell_type(const mesh::CellFace& face) const { return solid_.cells.type[static_cast<std::size_t>(face.cell)]; }

  const mesh::Mesh& solid_;
  bool surface_;
  std::vector<mesh::CellFace> faces_;
};

// The panels of all faces. Returns the first panel of each face, and their number.
std::vector<Local> add_panels(const mesh::Mesh& solid, const Border& border, const std::vector<Local>& place, mesh::Mesh& skin)
{
  std::vector<Local> first;
  for (const auto& face : border.faces()) {
    const auto cell = static_cast<std::size_t>(face.cell);
    const auto type = border.type(face);
    first.push_back(static_cast<Local>(skin.cells.size()));
    Global key = keys_a_cell * solid.cell_id[cell] + panels_a_face * face.face;
    for (const auto& panel : panels_of(type, border.nodes(face))) {
      add(mesh::dimension(type) == 1 ? mesh::CellType::line2 : mesh::CellType::tri3, panel, place, skin.cells);
      skin.cell_id.push_back(key++);
      skin.cell_body.push_back(solid.cell_body[cell]);
      if (!solid.cell_volume.empty()) skin.cell_volume.push_back(solid.cell_volume[cell]);
    }
  }
  first.push_back(static_cast<Local>(skin.cells.size()));
  return first;
}

// The skin of a solid, or of what is a surface already; cell_id holds the keys of the panels. `place`: of each node of the solid
// in the skin, of those inside after the others.
mesh::Mesh skin_of(const mesh::Mesh& solid, int dimension, std::vector<Local>& place)
{
  const Border border(solid, dimension);
  const auto on = border.has_node();
  mesh::Mesh skin;
  place.assign(solid.node_count(), 0);
  Local next = 0;
  for (const bool outside : {true, false})
    for (std::size_t n = 0; n < on.size(); ++n)
      if (on[n] == outside) place[n] = next++;
  for (std::size_t n = 0; n < on.size(); ++n) {
    if (!on[n]) continue;
    skin.node_id.push_back(solid.node_id[n]);
    skin.points.push_back(solid.points[n]);
  }
  const auto first = add_panels(solid, border, place, skin);
  for (std::size_t f = 0; f < solid.facets.cells.size(); ++f) {
    const auto index = border.find(f);
    for (Local p = first[index]; p < first[index + 1]; ++p) {
      const auto panel = static_cast<std::size_t>(p);
      skin.facets.cells.add(skin.cells.type[panel], skin.cells[panel]);
      skin.facets.parent.push_back(p);
      skin.facets.boundary.push_back(solid.facets.boundary[f]);
    }
  }
  return skin;
}

// The solid with its nodes in another order.
mesh::Mesh reordered(const mesh::Mesh& solid, const std::vector<Local>& place)
{
  mesh::Mesh result = solid;
  for (std::size_t n = 0; n < place.size(); ++n) {
    result.node_id[static_cast<std::size_t>(place[n])] = solid.node_id[n];
    result.points[static_cast<std::size_t>(place[n])] = solid.points[n];
  }
  for (auto* cells : {&result.cells, &result.facets.cells})
    for (auto& n : cells->nodes) n = place[static_cast<std::size_t>(n)];
  return result;
}

struct Numbering {
  std::vector<Global> number;  // of each key: its place among the different keys of all ranks, in ascending order
  Global count = 0;            // of different keys
};

// Each rank looks after a range of keys. Collective.
Numbering number(const std::vector<Global>& keys, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  const Global largest = comm.max(keys.empty() ? 0LL : *std::max_element(keys.begin(), keys.end()));
  const Global range = largest / comm.size() + 1;
  std::vector<std::vector<Global>> send(ranks);
  for (const Global key : keys) send[static_cast<std::size_t>(key / range)].push_back(key);
  auto received = comm.exchange(send);
  std::vector<Global> own;
  for (const auto& part : received) own.insert(own.end(), part.begin(), part.end());
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  const auto mine = static_cast<Global>(own.size());
  const Global before = comm.offset(mine);
  for (auto& part : received)
    for (auto& key : part) key = before + (std::lower_bound(own.begin(), own.end(), key) - own.begin());
  const auto answers = comm.exchange(received);
  Numbering result{{}, comm.sum(mine)};
  std::vector<std::size_t> next(ranks, 0);
  for (const Global key : keys) {
    const auto rank = static_cast<std::size_t>(key / range);
    result.number.push_back(answers[rank][next[rank]++]);
  }
  return result;
}

// Numbers what `visit` shows anew, from `first`; returns how many there are. Collective.
template <class Visit>
Global renumber(const Visit& visit, Global first, const Communicator& comm)
{
  std::vector<Global> keys;
  visit([&](const Global& id) { keys.push_back(id); });
  const auto numbers = number(keys, comm);
  std::size_t next = 0;
  visit([&](Global& id) { id = first + numbers.number[next++]; });
  return numbers.count;
}

}  // namespace

Decomposition skins(Decomposition decomposition, const std::vector<bool>& of_body, bool keep_inside, const Communicator& comm)
{
  if (std::none_of(of_body.begin(), of_body.end(), [](bool of) { return of; })) return decomposition;
  auto& subdomains = decomposition.subdomains;
  for (auto& subdomain : subdomains) {
    auto& mesh = subdomain.mesh;
    if (!of_body[static_cast<std::size_t>(subdomain.body)]) {
      for (auto& id : mesh.cell_id) id *= keys_a_cell;
      continue;
    }
    std::vector<Local> place;
    auto skin = skin_of(mesh, decomposition.catalogue.dimension, place);
    if (keep_inside && !is_surface(mesh, decomposition.catalogue.dimension)) subdomain.inside = reordered(mesh, place);
    mesh = std::move(skin);
    subdomain.skin = true;
  }
  auto& catalogue = decomposition.catalogue;
  const auto nodes = [&](const auto& use) {
    for (auto& subdomain : subdomains)
      for (auto& id : subdomain.mesh.node_id) use(id);
  };
  const auto cells = [&](const auto& use) {
    for (auto& subdomain : subdomains)
      for (auto& id : subdomain.mesh.cell_id) use(id);
  };
  const auto nodes_inside = [&](const auto& use) {
    for (auto& subdomain : subdomains)
      for (std::size_t n = subdomain.mesh.node_count(); n < subdomain.inside.node_count(); ++n) use(subdomain.inside.node_id[n]);
  };
  catalogue.node_count = renumber(nodes, 0, comm);
  catalogue.cell_count = renumber(cells, 0, comm);
  renumber(nodes_inside, catalogue.node_count, comm);
  for (auto& subdomain : subdomains)
    if (subdomain.inside.node_count() > 0)
      std::copy(subdomain.mesh.node_id.begin(), subdomain.mesh.node_id.end(), subdomain.inside.node_id.begin());
  return decomposition;
}

}  // namespace mortise::partition
