#include "analysis/symmetric_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "held_faces.hpp"
#include "nodes_in_rows.hpp"
#include "planes_at_copies.hpp"
#include "rotated_nodes.hpp"
#include "sent_points.hpp"
#include "shear_free_nodes.hpp"

namespace mortise::analysis {

namespace {

using Kind = model::FaceAction::Kind;

constexpr double parallel = 1e-3;     // angle between what is meant to be parallel in a mesh, and distance from a plane over size
constexpr double right_angle = 1e-2;  // its cosine, likewise

// To the homes of the nodes. Collective.
std::vector<model::FaceAction> sent_home(const std::vector<model::FaceAction>& actions, const partition::NodeHomes& homes,
                                         const Communicator& comm)
{
  std::vector<std::vector<model::FaceAction>> send(static_cast<std::size_t>(comm.size()));
  for (const auto& action : actions) send[homes(action.node)].push_back(action);
  std::vector<model::FaceAction> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  return result;
}

// The nodes that the rows of a contact node speak of, each once.
std::vector<Global> nodes_of(const constraint::Contacts& contacts, const constraint::ContactNode& node)
{
  std::vector<Global> nodes{node.node};
  for (std::size_t row = node.row; row <= node.row + node.tangents.size(); ++row)
    for (const auto& entry : contacts.rows[row]) nodes.push_back(entry.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// A node that supports hold along this normal.
struct PrescribedNormal {
  Global node;
  std::array<double, 3> normal;
};

// Those of one node.
std::span<const PrescribedNormal> planes_at(std::span<const PrescribedNormal> prescribed, Global node)
{
  const auto [begin, end] =
      std::equal_range(prescribed.begin(), prescribed.end(), PrescribedNormal{node, {}},
                       [](const PrescribedNormal& a, const PrescribedNormal& b) { return a.node < b.node; });
  return {begin, end};
}

// The planes of those of `nodes` that `actions`, on the homes of their nodes, hold; ascending. Collective.
std::vector<PrescribedNormal> prescribed_normals(std::span<const Global> nodes, const std::vector<model::FaceAction>& actions,
                                                 const partition::NodeHomes& homes, const Communicator& comm)
{
  const auto by_node = [](const PrescribedNormal& a, const PrescribedNormal& b) { return a.node < b.node; };
  std::vector<PrescribedNormal> prescribed;
  for (const auto& action : actions)
    if (action.kind == Kind::prescribed) prescribed.push_back({action.node, action.normal});
  std::sort(prescribed.begin(), prescribed.end(), by_node);
  std::vector<std::vector<Global>> asked(static_cast<std::size_t>(comm.size()));
  for (const Global node : nodes) asked[homes(node)].push_back(node);
  std::vector<std::vector<PrescribedNormal>> answers;
  for (const auto& part : comm.exchange(asked)) {
    auto& answer = answers.emplace_back();
    for (const Global node : part) {
      const auto planes = planes_at(prescribed, node);
      answer.insert(answer.end(), planes.begin(), planes.end());
    }
  }
  std::vector<PrescribedNormal> result;
  for (const auto& part : comm.exchange(answers)) result.insert(result.end(), part.begin(), part.end());
  std::sort(result.begin(), result.end(), by_node);
  return result;
}

// Drops faces of curved surfaces, which have neighbours that are held along other normals, and faces at edges with more than a
// right angle. Collective.
void drop_curved(std::vector<model::FaceAction>& actions, const partition::NodeHomes& homes, const Communicator& comm)
{
  std::vector<Global> nodes;
  for (const auto& action : actions)
    if (action.kind == Kind::prescribed) nodes.push_back(action.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto prescribed = prescribed_normals(nodes, sent_home(actions, homes, comm), homes, comm);
  std::set<Global> curved;
  for (const auto& action : actions) {
    if (action.kind != Kind::prescribed) continue;
    const Point normal = point(action.normal);
    for (const auto& other : planes_at(prescribed, action.node))
      if (const Point n = point(other.normal); (n - normal).norm() > parallel && n.dot(normal) > right_angle)
        curved.insert(action.face);
  }
  std::erase_if(actions, [&](const auto& action) { return action.kind == Kind::prescribed && curved.contains(action.face); });
}

// What contacts push along their surfaces with, at nodes that supports hold along normals. Rows along which supports hold both
// sides have no entries. Bonds have no row where supports hold the secondary side; they push all the same unless the primary side
// is held as well.
class ContactForces {
 public:
  // Collective.
  ContactForces(const constraint::Contacts& contacts, const std::vector<model::FaceAction>& actions,
                const partition::NodeHomes& homes, const Communicator& comm)
      : contacts_(contacts)
  {
    std::vector<Global> all;
    for (std::size_t i = 0; i < contacts.nodes.size(); ++i)
      if (contacts.bonded[i] || !contacts.nodes[i].tangents.empty()) {
        const auto nodes = nodes_of(contacts, contacts.nodes[i]);
        all.insert(all.end(), nodes.begin(), nodes.end());
      }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    prescribed_ = prescribed_normals(all, actions, homes, comm);
    for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
      const auto& node = contacts.nodes[i];
      for (std::size_t t = 0; t < node.tangents.size(); ++t) add_row(node, node.row + 1 + t, node.tangents[t]);
      if (contacts.bonded[i]) add_bond(node);
    }
  }

  std::vector<model::FaceAction> found;

 private:
  void add(Global node, const constraint::ContactNode& at, const Point& direction)
  {
    found.push_back({node, components(at.at), components(at.normal), components(direction), 0, 0, Kind::pushed});
  }

  void add_row(const constraint::ContactNode& at, std::size_t row, const Point& tangent)
  {
    if (contacts_.rows[row].empty() && contacts_.rows.bound[row] == 0) return;
    for (const Global node : nodes_of(contacts_, at))
      if (!planes_at(prescribed_, node).empty()) add(node, at, tangent);
  }

  void add_bond(const constraint::ContactNode& at)
  {
    for (const auto& own : planes_at(prescribed_, at.node)) {
      bool both = false;
      for (std::size_t row = at.row; row <= at.row + at.tangents.size(); ++row)
        for (const auto& entry : contacts_.rows[row])
          for (const auto& other : planes_at(prescribed_, entry.node))
            both = both || (entry.node != at.node && (point(own.normal) - point(other.normal)).norm() < parallel);
      if (!both) add(at.node, at, point(own.normal));
    }
  }

  const constraint::Contacts& contacts_;
  std::vector<PrescribedNormal> prescribed_;
};

// What acts at one node.
using Actions = std::span<const model::FaceAction>;

// Whether it shears the plane with this normal through the node's place.
bool shears(const model::FaceAction& action, const Point& normal, const Point& place, double rounding)
{
  if (action.kind == Kind::prescribed) return false;
  if (action.kind == Kind::coupled) return true;
  const double beyond = (point(action.at) - place).dot(normal);
  if (std::abs(beyond) > rounding) return beyond > 0;
  const Point face = point(action.normal), direction = point(action.direction);
  const Point tangential = direction - direction.dot(face) * face;
  if (face.cross(normal).norm() < parallel) return tangential.norm() > parallel;
  // What pushes along the plane is its own mirror image, however faces of the mesh are inclined.
  return action.kind == Kind::pushed && std::abs(tangential.dot(normal)) > parallel && std::abs(direction.dot(normal)) > parallel;
}

// The normals of planes of symmetry.
std::vector<Point> normals_of(Actions actions)
{
  std::vector<Point> normals;
  Point place = Point::Zero();
  double rounding = 0;
  for (const auto& action : actions) {
    if (action.kind != Kind::prescribed) continue;
    const Point normal = point(action.normal);
    if (std::none_of(normals.begin(), normals.end(), [&](const Point& n) { return (n - normal).norm() < parallel; }))
      normals.push_back(normal);
    place = point(action.at);
    rounding = std::max(rounding, parallel * action.size);
  }
  std::erase_if(normals, [&](const Point& normal) {
    return std::any_of(actions.begin(), actions.end(),
                       [&](const auto& action) { return shears(action, normal, place, rounding); });
  });
  return normals;
}

// The planes of each node at all of its copies, from what acts there, on its home. Collective.
std::vector<std::vector<post::SymmetricNode>> at_copies(std::vector<model::FaceAction> actions,
                                                        const partition::Decomposition& decomposition,
                                                        const partition::NodeHomes& homes, const Communicator& comm)
{
  std::sort(actions.begin(), actions.end(), [](const model::FaceAction& a, const model::FaceAction& b) {
    return std::tie(a.node, a.kind, a.normal, a.at, a.direction, a.size) <
           std::tie(b.node, b.kind, b.normal, b.at, b.direction, b.size);
  });
  std::vector<Global> nodes;
  std::vector<std::vector<Point>> normals;
  for (std::size_t i = 0, end = 0; i < actions.size(); i = end) {
    while (end < actions.size() && actions[end].node == actions[i].node) ++end;
    auto found = normals_of(std::span(actions).subspan(i, end - i));
    if (found.empty()) continue;
    nodes.push_back(actions[i].node);
    normals.push_back(std::move(found));
  }
  return planes_at_copies(nodes, normals, decomposition, homes, comm);
}

// Whether a cell at the node reaches beyond the plane.
bool reaches_beyond(const mesh::Mesh& mesh, std::size_t cell, Local node, const Point& normal)
{
  const Point& x = mesh.points[static_cast<std::size_t>(node)];
  const auto nodes = mesh.cells[cell];
  return std::any_of(nodes.begin(), nodes.end(), [&](Local n) {
    const Point to = mesh.points[static_cast<std::size_t>(n)] - x;
    return to.dot(normal) > 2 * parallel * to.norm();
  });
}

// Drops planes that the body crosses, in any of the subdomains round the node.
void drop_crossed(std::vector<std::vector<post::SymmetricNode>>& symmetric, const partition::Decomposition& decomposition,
                  const partition::Interface& interface, const Communicator& comm)
{
  std::size_t most = 0;
  for (const auto& nodes : symmetric)
    for (const auto& at : nodes) most = std::max(most, at.normals.size());
  most = static_cast<std::size_t>(comm.max(static_cast<long long>(most)));
  std::vector<Eigen::MatrixXd> crossings;
  for (std::size_t s = 0; s < symmetric.size(); ++s) {
    const auto& mesh = decomposition.subdomains[s].mesh;
    auto& count = crossings.emplace_back(
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.node_count()), static_cast<Eigen::Index>(most)));
    std::vector<const post::SymmetricNode*> at(mesh.node_count(), nullptr);
    for (const auto& own : symmetric[s]) at[static_cast<std::size_t>(own.node)] = &own;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      for (const Local n : mesh.cells[c])
        if (const auto* own = at[static_cast<std::size_t>(n)])
          for (std::size_t k = 0; k < own->normals.size(); ++k)
            count(n, static_cast<Eigen::Index>(k)) += reaches_beyond(mesh, c, n, own->normals[k]);
  }
  partition::sum_over_copies(decomposition, interface, crossings, comm);
  for (std::size_t s = 0; s < symmetric.size(); ++s) {
    for (auto& at : symmetric[s]) {
      Eigen::Index k = 0;
      std::erase_if(at.normals, [&](const Point&) { return crossings[s](at.node, k++) > 0; });
    }
    std::erase_if(symmetric[s], [](const auto& at) { return at.normals.empty(); });
  }
}

// Nodes on the axis of revolution are on all planes through it: two stand for them, that across the model and one askew.
void turn_about_axis(std::vector<std::vector<post::SymmetricNode>>& symmetric, const partition::Decomposition& decomposition,
                     double rounding)
{
  const Point askew(0.5, 0, std::sqrt(0.75));
  for (std::size_t s = 0; s < symmetric.size(); ++s)
    for (auto& at : symmetric[s]) {
      const bool on_axis = std::abs(decomposition.subdomains[s].mesh.points[static_cast<std::size_t>(at.node)][0]) <= rounding;
      if (on_axis && at.normals.front()[0] == -1) at.normals.push_back(askew);
    }
}

// Collective.
std::vector<std::vector<post::SymmetricNode>> find_mirrored_nodes(const model::Model& model, const Rows& rows,
                                                                  const partition::NodeHomes& homes,
                                                                  const partition::Interface& interface, const Communicator& comm)
{
  auto actions = model.face_actions(rows.acts, comm);
  if (!comm.any(std::any_of(actions.begin(), actions.end(), [](const auto& a) { return a.kind == Kind::prescribed; }))) return {};
  drop_curved(actions, homes, comm);
  actions = sent_home(actions, homes, comm);
  const auto pushed = sent_home(ContactForces(rows.constraints.contacts, actions, homes, comm).found, homes, comm);
  actions.insert(actions.end(), pushed.begin(), pushed.end());
  auto symmetric = at_copies(std::move(actions), model.decomposition(), homes, comm);
  drop_crossed(symmetric, model.decomposition(), interface, comm);
  if (model.deck().axisymmetric()) turn_about_axis(symmetric, model.decomposition(), model.rounding(comm));
  return symmetric;
}

}  // namespace

post::SymmetricNodes find_symmetric_nodes(const model::Model& model, const Rows& rows, const partition::NodeDirectory& directory,
                                          const partition::Interface& interface, const Communicator& comm)
{
  auto others = nodes_in_rows(rows.constraints.contacts);
  const auto without_rows = nodes_without_rows(rows.constraints.contacts);
  others.insert(others.end(), without_rows.begin(), without_rows.end());
  const partition::NodeHomes homes(model.decomposition(), interface, directory, others, comm);
  return {find_mirrored_nodes(model, rows, homes, interface, comm),
          find_rotated_nodes(rows, model.decomposition(), directory, comm), find_shear_free_nodes(model, rows, homes, comm),
          find_held_faces(model, rows, homes, comm)};
}

}  // namespace mortise::analysis
