#include "held_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "at_nodes.hpp"
#include "mesh/face_area.hpp"
#include "sent_points.hpp"

namespace mortise::analysis {

namespace {

constexpr double one_side = 0.5;  // cosine of the angle between normals of one side, or more

// What acts on an outer face.
struct FaceLoad {
  bool known = true;    // its traction
  bool holds = false;   // its nodes, not along its normal alone
  double pressure = 0;  // sum over the nodes
};
using FaceLoads = std::unordered_map<Global, FaceLoad>;  // of faces that bear something

// The cuts of sectors and bolts go through bodies, which hold nothing there.
bool is_cut(const contact::Options& contact)
{
  return contact.cyclic || contact.preload;
}

// Of this rank's outer faces. Collective.
FaceLoads loads_of_faces(const model::Model& model, const Rows& rows, const Communicator& comm)
{
  using Kind = model::FaceAction::Kind;
  FaceLoads result;
  for (const auto& action : model.face_actions(rows.acts, comm)) {
    auto& load = result[action.face];
    load.known = false;
    load.holds = load.holds || action.kind == Kind::tangential || action.kind == Kind::coupled;
  }
  for (const auto& pair : rows.pairs)
    for (const auto* side : {&pair.secondary, pair.primary.get()})
      for (std::size_t f = 0; side && f < side->face_id.size(); ++f) {
        auto& load = result[side->face_id[f]];
        load.known = false;
        load.holds = load.holds || !is_cut(pair.options);
      }
  for (const auto& pressed : model.face_pressures(rows.acts)) result[pressed.face].pressure += pressed.pressure;
  return result;
}

// One thing that holds a node: in all directions, across a contact, along a component or another direction that is orthogonal to
// the others.
constexpr int in_all = -2, across_contact = -1, first_skew = 3;
struct Hold {
  Global node;
  int direction;
  auto operator<=>(const Hold&) const = default;
};

// On the homes of the nodes, ascending, each once. Collective.
std::vector<Hold> holds_at_nodes(const Rows& rows, const partition::NodeHomes& homes, const Communicator& comm)
{
  std::vector<std::vector<Hold>> send(static_cast<std::size_t>(comm.size()));
  const auto hold = [&](Global node, int direction) { send[homes(node)].push_back({node, direction}); };
  const auto hold_by = [&](int contact, Global node) {
    const auto& options = rows.pairs[static_cast<std::size_t>(contact)].options;
    if (!is_cut(options)) hold(node, options.law == contact::Law::frictionless ? across_contact : in_all);
  };
  for (const auto& dof : rows.constraints.prescribed) hold(dof.node, dof.component);
  std::unordered_map<Global, int> skew;
  for (const auto& support : rows.constraints.skew_supports) hold(support.node, first_skew + skew[support.node]++);
  const auto& contacts = rows.constraints.contacts;
  for (const auto& node : contacts.nodes) {
    hold_by(node.contact, node.node);
    for (std::size_t row = node.row; row <= node.row + node.tangents.size(); ++row)
      for (const auto& entry : contacts.rows[row]) hold_by(node.contact, entry.node);
  }
  for (const auto& node : contacts.without_rows) hold_by(node.contact, node.node);
  std::vector<Hold> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  std::ranges::sort(result);
  result.erase(std::ranges::unique(result).begin(), result.end());
  return result;
}

// Whether a node that is held so is held in every direction; if not, whether a contact holds it.
bool hold_all(std::span<const Hold> holds, int dimension)
{
  const auto directions = std::ranges::count_if(holds, [](const Hold& h) { return h.direction >= 0; });
  return directions >= dimension || (!holds.empty() && holds.front().direction == in_all);
}
bool hold_across(std::span<const Hold> holds)
{
  return !holds.empty() && holds.front().direction == across_contact;
}

// A face that holds its nodes, at one of them; the length of its normal is its area.
struct NormalAtNode {
  Global node, face;
  std::array<double, 3> normal;
};

// On the homes of the nodes, ascending. Collective.
std::vector<NormalAtNode> normals_at_nodes(const mesh::Surface& surface, const FaceLoads& loads,
                                           const partition::NodeHomes& homes, const Communicator& comm)
{
  std::vector<std::vector<NormalAtNode>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto load = loads.find(surface.face_id[f]);
    if (load == loads.end() || !load->second.holds || mesh::second_order(surface.faces.type[f])) continue;
    const auto nodes = surface.faces[f];
    const Point normal = mesh::area_vector(surface.points, nodes, surface.faces.type[f]);
    for (const Local n : nodes) {
      const Global node = surface.node_id[static_cast<std::size_t>(n)];
      send[homes(node)].push_back({node, surface.face_id[f], components(normal)});
    }
  }
  return by_node_and_face(send, comm);
}

// A copy of a held node: the unit normal of the faces that hold it, out of the body.
struct HeldNode {
  Global subdomain;
  Local node;
  std::array<double, 3> normal;
  bool slides;  // is held across a contact alone
};

// Of this rank's subdomains. Collective.
std::vector<HeldNode> held_nodes(const model::Model& model, const Rows& rows, const FaceLoads& loads,
                                 const partition::NodeHomes& homes, const Communicator& comm)
{
  const auto& decomposition = model.decomposition();
  const auto normals = normals_at_nodes(model.outer_surface(comm), loads, homes, comm);
  const auto holds = holds_at_nodes(rows, homes, comm);
  std::vector<std::vector<HeldNode>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0, end = 0; i < normals.size(); i = end) {
    Point sum = Point::Zero();
    for (; end < normals.size() && normals[end].node == normals[i].node; ++end) sum += point(normals[end].normal);
    const auto here = std::ranges::equal_range(holds, normals[i].node, {}, &Hold::node);
    const bool held = hold_all(here, decomposition.catalogue.dimension);
    if (!(held || hold_across(here)) || !(sum.norm() > 0)) continue;
    for (const auto& copy : homes.copies(normals[i].node))
      send[static_cast<std::size_t>(decomposition.rank_of(copy.subdomain))].push_back(
          {copy.subdomain, copy.node, components(sum.normalized()), !held});
  }
  std::vector<HeldNode> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  return result;
}

// The direction from one held side to the other: between the two of these normals that are most unlike. Zero if all are on one
// side.
Point direction_across(std::span<const HeldNode* const> nodes)
{
  Point result = Point::Zero();
  double least = one_side;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Point a = point(nodes[i]->normal), b = point(nodes[j]->normal);
      if (!(a.dot(b) < least - 1e-9)) continue;
      least = a.dot(b);
      result = (a - b).normalized();
    }
  return result;
}

// Whether a face that only some nodes are held of may count: outer ones, on one side from corner to corner.
bool ends_inside(mesh::CellType type, std::span<const HeldNode* const> held, double traction)
{
  return !std::isnan(traction) && static_cast<int>(held.size()) >= mesh::dimension(type) - 1 &&
         std::ranges::none_of(held, [](const HeldNode* at) { return at->slides; }) && direction_across(held).isZero(0);
}

// Those of one subdomain. `held`: of each node, null if it is not; `outer`: faces of the rank, ascending.
std::vector<fem::HeldFace> held_faces_of(const mesh::Mesh& mesh, std::span<const HeldNode* const> held, const FaceLoads& loads,
                                         std::span<const Global> outer)
{
  std::vector<fem::HeldFace> result;
  std::vector<const HeldNode*> own;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto& faces = mesh::faces(mesh.cells.type[c]);
    for (std::size_t f = 0; f < faces.size() && !mesh::second_order(mesh.cells.type[c]); ++f) {
      own.clear();
      for (const int k : faces[f].nodes)
        if (const auto* at = held[static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(k)])]) own.push_back(at);
      if (own.empty()) continue;
      const bool all = own.size() == faces[f].nodes.size();
      const Point across = all ? direction_across(own) : point(own.front()->normal);
      const Global id = 6 * mesh.cell_id[c] + static_cast<Global>(f);  // partition::face_number()
      const auto load = loads.find(id);
      const bool known = load == loads.end() || (load->second.known && !std::isnan(load->second.pressure));
      if (across.isZero(0) || !known) continue;
      double traction = std::numeric_limits<double>::quiet_NaN();
      if (std::ranges::binary_search(outer, id))
        traction = load == loads.end() ? 0 : -load->second.pressure / static_cast<double>(faces[f].nodes.size());
      if (!all && !ends_inside(mesh.cells.type[c], own, traction)) continue;
      const bool slides = std::ranges::any_of(own, [](const HeldNode* at) { return at->slides; });
      result.push_back({static_cast<Local>(c), static_cast<int>(f), across, traction, slides, !all});
    }
  }
  return result;
}

}  // namespace

std::vector<Global> nodes_without_rows(const constraint::Contacts& contacts)
{
  std::vector<Global> nodes;
  for (const auto& node : contacts.without_rows) nodes.push_back(node.node);
  return nodes;
}

std::vector<std::vector<fem::HeldFace>> find_held_faces(const model::Model& model, const Rows& rows,
                                                        const partition::NodeHomes& homes, const Communicator& comm)
{
  const auto& decomposition = model.decomposition();
  const auto loads = loads_of_faces(model, rows, comm);
  const auto nodes = held_nodes(model, rows, loads, homes, comm);
  std::vector<std::vector<const HeldNode*>> held(decomposition.subdomains.size());
  const Global first = decomposition.first[static_cast<std::size_t>(comm.rank())];
  for (const auto& at : nodes) {
    const auto s = static_cast<std::size_t>(at.subdomain - first);
    held[s].resize(decomposition.subdomains[s].mesh.node_count(), nullptr);
    held[s][static_cast<std::size_t>(at.node)] = &at;
  }
  std::vector<Global> outer = model.outer_surface(comm).face_id;
  std::ranges::sort(outer);
  std::vector<std::vector<fem::HeldFace>> result(decomposition.subdomains.size());
  for (std::size_t s = 0; s < result.size(); ++s)
    if (!decomposition.subdomains[s].skin && !held[s].empty())
      result[s] = held_faces_of(decomposition.subdomains[s].mesh, held[s], loads, outer);
  return result;
}

}  // namespace mortise::analysis
