#include "post/contact_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "base/dense.hpp"
#include "post/drift.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

// What a row needs to know of a node: its displacement and body, the size of the faces of secondary sides at it, that of all, and
// the sum of their unit normals.
struct Nodal {
  Global node;
  double u[3] = {0, 0, 0};
  int body = 0;
  double secondary_size = 0, size = 0;
  double normals[3] = {0, 0, 0}, faces = 0;

  void take(const Nodal& other)
  {
    secondary_size = std::max(secondary_size, other.secondary_size);
    size = std::max(size, other.size);
    for (int c = 0; c < 3; ++c) normals[c] += other.normals[c];
    faces += other.faces;
  }
  // Between two faces at the node, about: the normals of two stand at half of it to their mean.
  double angle() const { return 2 * std::acos(std::min(Eigen::Map<const Point>(normals).norm() / std::max(faces, 1.0), 1.0)); }
};

// Of its corners.
Point unit_normal(const mesh::Surface& surface, std::size_t face)
{
  const auto nodes = surface.faces[face];
  const auto at = [&](std::size_t i) { return surface.points[static_cast<std::size_t>(nodes[i])]; };
  const int corners = mesh::corner_count(surface.faces.type[face]);
  if (corners == 2) return Point(at(1)[1] - at(0)[1], at(0)[0] - at(1)[0], 0).normalized();
  return corners == 3 ? (at(1) - at(0)).cross(at(2) - at(0)).normalized() : (at(2) - at(0)).cross(at(3) - at(1)).normalized();
}

double size_of(const mesh::Surface& surface, std::size_t face)
{
  const auto nodes = surface.faces[face];
  const int corners = mesh::corner_count(surface.faces.type[face]);
  double result = 0;
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < i; ++j)
      result = std::max(result, (surface.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])] -
                                 surface.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(j)])])
                                    .norm());
  return result;
}

// This rank's nodes of all sides.
std::vector<Nodal> own_nodes(std::span<const contact::Pair> pairs, const partition::Decomposition& decomposition,
                             const std::vector<Eigen::VectorXd>& displacement)
{
  std::unordered_map<Global, Nodal> seen;
  const auto look = [&](const mesh::Surface& surface, bool secondary) {
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const double size = size_of(surface, f);
      const Point normal = unit_normal(surface, f);
      for (const Local n : surface.faces[f]) {
        const Global node = surface.node_id[static_cast<std::size_t>(n)];
        seen.try_emplace(node, Nodal{node})
            .first->second.take({node, {}, 0, secondary ? size : 0, size, {normal[0], normal[1], normal[2]}, 1});
      }
    }
  };
  for (const auto& pair : pairs) {
    look(pair.secondary, true);
    if (pair.primary) look(*pair.primary, false);
  }
  const int dimension = decomposition.catalogue.dimension;
  std::vector<Nodal> result;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& ids = decomposition.subdomains[s].mesh.node_id;
    for (std::size_t n = 0; n < ids.size(); ++n) {
      const auto found = seen.find(ids[n]);
      if (found == seen.end()) continue;
      Nodal& nodal = found->second;
      for (int c = 0; c < dimension; ++c) nodal.u[c] = displacement[s][static_cast<Eigen::Index>(n) * dimension + c];
      nodal.body = decomposition.subdomains[s].body;
      result.push_back(nodal);
      nodal = Nodal{ids[n]};  // other subdomains have no faces of their own there
    }
  }
  return result;
}

// Of the nodes asked for what all ranks know; nodes meet on rank node % ranks. Collective.
std::unordered_map<Global, Nodal> fetch(std::vector<Global> nodes, const std::vector<Nodal>& own, const Communicator& comm)
{
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Nodal>> told(ranks);
  std::vector<std::vector<Global>> wanted(ranks);
  for (const auto& nodal : own) told[static_cast<std::size_t>(nodal.node) % ranks].push_back(nodal);
  for (const Global node : nodes) wanted[static_cast<std::size_t>(node) % ranks].push_back(node);
  std::unordered_map<Global, Nodal> known;
  for (const auto& part : comm.exchange(told))
    for (const auto& nodal : part) {
      const auto [place, fresh] = known.emplace(nodal.node, nodal);
      if (!fresh) place->second.take(nodal);
    }
  std::vector<std::vector<Nodal>> answers(ranks);
  const auto asked = comm.exchange(wanted);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const Global node : asked[r])
      if (const auto found = known.find(node); found != known.end()) answers[r].push_back(found->second);
  std::unordered_map<Global, Nodal> result;
  for (const auto& part : comm.exchange(answers))
    for (const auto& nodal : part) result.emplace(nodal.node, nodal);
  return result;
}

bool touches(std::span<const contact::Pair> pairs, const contact::ContactNodeState& point)
{
  const auto& options = pairs[static_cast<std::size_t>(point.contact)].options;
  return point.status != contact::Status::open && options.law != contact::Law::bonded && !options.cyclic;
}

// Of the nodes in rows of closed points.
std::unordered_map<Global, Nodal> nodes_at_contact(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                                   std::span<const contact::ContactNodeState> states,
                                                   const partition::Decomposition& decomposition,
                                                   const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  std::vector<Global> wanted;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!touches(pairs, states[i])) continue;
    wanted.push_back(contacts.nodes[i].node);
    for (const auto& entry : contacts.rows[contacts.nodes[i].row]) wanted.push_back(entry.node);
  }
  return fetch(std::move(wanted), own_nodes(pairs, decomposition, displacement), comm);
}

// The jump of the displacements at a point, along the surface. A normal row has m n at each node; of nodes that supports hold in
// part it has the other components.
Point tangential_jump(const constraint::Contacts& contacts, const constraint::ContactNode& point,
                      const std::unordered_map<Global, Nodal>& nodes)
{
  std::map<Global, std::array<double, 2>> parts;  // of each node: |n_c| of the best component, m from it
  for (const auto& entry : contacts.rows[point.row]) {
    const double n = point.normal[entry.component];
    auto& [best, m] = parts[entry.node];
    if (std::abs(n) > best) best = std::abs(n), m = entry.coefficient / n;
  }
  Point jump = Point::Zero();
  for (const auto& [node, part] : parts)
    if (const auto found = nodes.find(node); found != nodes.end()) jump += part[1] * Eigen::Map<const Point>(found->second.u);
  jump /= point.weight;
  return jump - jump.dot(point.normal) * point.normal;
}

}  // namespace

std::vector<Warning> long_slides(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                 std::span<const contact::ContactNodeState> states, const partition::Decomposition& decomposition,
                                 const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const auto nodes = nodes_at_contact(pairs, contacts, states, decomposition, displacement, comm);
  std::vector<Found> longest(pairs.size()), parts(pairs.size());  // slide; slide over size of the face
  std::vector<double> closed(pairs.size(), 0.0);                  // nodes
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!touches(pairs, states[i])) continue;
    const auto& point = contacts.nodes[i];
    closed[static_cast<std::size_t>(point.contact)] += 1;
    const auto found = nodes.find(point.node);
    if (found == nodes.end() || !(found->second.secondary_size > 0)) continue;
    const double slide = tangential_jump(contacts, point, nodes).norm();
    const auto c = static_cast<std::size_t>(point.contact);
    parts[c].take(slide / found->second.secondary_size, point.at);
    longest[c].take(slide, point.at);
  }
  parts = largest_of_ranks(parts, comm);
  longest = largest_of_ranks(longest, comm);
  comm.sum_in_place(closed);
  // Of the corners of one facet: what is round turns until it stands on it.
  constexpr double part_on_a_facet = 0.1;
  const double corners = decomposition.catalogue.dimension;
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const bool on_a_facet = closed[c] <= corners;
    const double limit = on_a_facet ? part_on_a_facet : 1;
    if (!(parts[c].value > limit)) continue;
    Warning w{
        "long_slide",
        fmt::format("in contact {} a point at {} slides over {:.3g} of its face, by up to {:.3g}: it presses where it stood "
                    "before, not where it came to{}",
                    pairs[c].options.name, spell(parts[c].at), parts[c].value, longest[c].value,
                    on_a_facet ? "; so few nodes press that, if the body is round, it turns until it stands on a facet" : ""),
        "draw the bodies where they come to rest, hold what slides, or take larger faces if the surfaces are flat"};
    w.at = parts[c].at;
    w.contact = pairs[c].options.name;
    w.boundary = pairs[c].options.secondary;
    w.value = parts[c].value;
    w.limit = limit;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "contacts");
}

namespace {

constexpr double presses = 1e-3;  // of the largest force of the contact's points

// The faces at what presses, of one side: the angle between two of them where the surface is flattest, their size, whose they
// are.
struct Facets {
  double flattest = std::numeric_limits<double>::infinity(), size = 0;
  int body = -1;

  void take(const Nodal& node)
  {
    flattest = std::min(flattest, node.angle());
    size = std::max(size, node.size);
    body = std::max(body, node.body);
  }
};

// Where a contact presses: how far along two directions of its surface (one in planes), of which the first is the narrowest, and
// on which faces of its secondary and its primary side.
struct Patch {
  double force = 0;
  Point normal = Point::Zero(), centre = Point::Zero();
  std::vector<Point> directions = {};
  std::vector<double> widths = {};
  std::array<Facets, 2> sides = {};
};

struct Moments {
  double force = 0;
  Point normal = Point::Zero(), first = Point::Zero();  // times the force, as all that follows
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};
static_assert(sizeof(Moments) == sizeof(double) * 16);

Patch patch_of(const Moments& moments, int dimension)
{
  if (!(moments.force > 0)) return {};
  const Point n = moments.normal.normalized(), centre = moments.first / moments.force;
  Patch patch{moments.force, n, centre};
  if (dimension == 2) {
    patch.directions = {Point(-n[1], n[0], 0)};
    return patch;
  }
  const Eigen::Matrix3d spread = moments.second / moments.force - centre * centre.transpose(),
                        along = Eigen::Matrix3d::Identity() - n * n.transpose();
  const double larger = 2 * spread.cwiseAbs().sum() + 1;
  const Eigen::Matrix3d axes =
      dense::space_eigenpairs(Eigen::Matrix3d(along * spread * along + larger * n * n.transpose())).vectors;
  patch.directions = {axes.col(0), axes.col(1)};  // the last one is the normal
  return patch;
}

// The faces that the rows of a point act on.
void take_faces(const constraint::Contacts& contacts, const constraint::ContactNode& point,
                const std::unordered_map<Global, Nodal>& nodes, std::array<Facets, 2>& sides)
{
  constexpr double much = 0.3;  // of the row: nodes of the primary side that it is near
  if (const auto found = nodes.find(point.node); found != nodes.end()) sides[0].take(found->second);
  for (const auto& entry : contacts.rows[point.row]) {
    const double n = point.normal[entry.component];
    const auto found = nodes.find(entry.node);
    if (found != nodes.end() && entry.coefficient * n < -much * point.weight * n * n) sides[1].take(found->second);
  }
}

std::vector<Patch> pressing_patches(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                    std::span<const contact::ContactNodeState> states,
                                    const std::unordered_map<Global, Nodal>& nodes, int dimension, const Communicator& comm)
{
  std::vector<double> largest(pairs.size(), 0.0);
  const auto for_each_point = [&](const auto& visit) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      const auto c = static_cast<std::size_t>(states[i].contact);
      if (touches(pairs, states[i]) && states[i].force > presses * largest[c]) visit(c, contacts.nodes[i], states[i].force);
    }
  };
  for_each_point([&](std::size_t c, const auto&, double force) { largest[c] = std::max(largest[c], force); });
  for (auto& force : largest) force = comm.max(force);
  std::vector<Moments> moments(pairs.size());
  for_each_point([&](std::size_t c, const constraint::ContactNode& point, double force) {
    moments[c].force += force;
    moments[c].normal += force * point.normal;
    moments[c].first += force * point.at;
    moments[c].second += force * point.at * point.at.transpose();
  });
  comm.sum_in_place({reinterpret_cast<double*>(moments.data()), moments.size() * 16});
  std::vector<Patch> result;
  for (const auto& sums : moments) result.push_back(patch_of(sums, dimension));
  std::vector<std::array<double, 4>> ends(pairs.size());  // of each direction minus the least place and the largest
  for (auto& end : ends) end.fill(-std::numeric_limits<double>::infinity());
  for_each_point([&](std::size_t c, const constraint::ContactNode& point, double) {
    for (std::size_t k = 0; k < result[c].directions.size(); ++k) {
      const double along = result[c].directions[k].dot(point.at - result[c].centre);
      ends[c][2 * k] = std::max(ends[c][2 * k], -along);
      ends[c][2 * k + 1] = std::max(ends[c][2 * k + 1], along);
    }
    take_faces(contacts, point, nodes, result[c].sides);
  });
  for (std::size_t c = 0; c < result.size(); ++c) {
    for (std::size_t k = 0; k < result[c].directions.size(); ++k)
      result[c].widths.push_back(comm.max(ends[c][2 * k]) + comm.max(ends[c][2 * k + 1]));
    for (auto& side : result[c].sides) {
      side.flattest = -comm.max(-side.flattest);
      side.size = comm.max(side.size);
      side.body = static_cast<int>(comm.max(static_cast<double>(side.body)));
    }
  }
  return result;
}

// Whether it is round there, and as narrow as that somewhere.
bool may_roll(const Patch& patch, const Facets& faces)
{
  constexpr double flat = 1e-3;
  return faces.body >= 0 && faces.flattest > flat &&
         std::ranges::any_of(patch.widths, [&](double width) { return width <= faces.size; });
}

// The part of a rotation by which one side rolls over the other where that is narrower than its faces.
double rolls_by(const Patch& patch, const Facets& faces, const Point& rotation)
{
  double square = 0;
  for (std::size_t k = 0; k < patch.directions.size(); ++k)
    if (patch.widths[k] <= faces.size) square += std::pow(rotation.dot(patch.normal.cross(patch.directions[k])), 2);
  return std::sqrt(square);
}

}  // namespace

std::vector<Warning> facet_turns(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                 std::span<const contact::ContactNodeState> states, const partition::Decomposition& decomposition,
                                 fem::Kinematics kinematics, const std::vector<Eigen::VectorXd>& displacement,
                                 const Communicator& comm)
{
  constexpr double part_of_angle = 0.005, rigid = 10;
  if (kinematics == fem::Kinematics::axisymmetric) return {};
  const auto nodes = nodes_at_contact(pairs, contacts, states, decomposition, displacement, comm);
  const auto patches = pressing_patches(pairs, contacts, states, nodes, decomposition.catalogue.dimension, comm);
  const auto some_may = [](const Patch& patch) {
    return std::ranges::any_of(patch.sides, [&](const Facets& side) { return may_roll(patch, side); });
  };
  if (std::ranges::none_of(patches, some_may)) return {};
  const auto motions = rigid_motions(decomposition, kinematics, displacement, comm);
  const auto rotation = [&](const Facets& side) {
    return side.body < 0 ? Point(Point::Zero()) : motions[static_cast<std::size_t>(side.body)].rigid.rotation;
  };
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& patch = patches[c];
    const Point turn = rotation(patch.sides[0]) - rotation(patch.sides[1]);
    for (const auto& side : patch.sides) {
      if (!may_roll(patch, side)) continue;
      const auto& motion = motions[static_cast<std::size_t>(side.body)];
      const double angle = rolls_by(patch, side, turn);
      if (!(angle > part_of_angle * side.flattest) || !(motion.turning > rigid * motion.rest)) continue;
      const auto& name = decomposition.catalogue.bodies[static_cast<std::size_t>(side.body)].name;
      Warning w{"facet_turn",
                fmt::format("body \"{}\" turns by {:.3g} in contact {} at {}, which presses on less than a face's width: if "
                            "nothing else stops it, what is round turns until it stands on facets of its mesh, {:.3g} apart; "
                            "forces are then those of the bodies meant, displacements are not",
                            name, angle, pairs[c].options.name, spell(patch.centre), side.flattest),
                "hold the body against turning, let a row of nodes lie where the bodies touch first, or refine there until "
                "several faces press"};
      w.at = patch.centre;
      w.body = name;
      w.contact = pairs[c].options.name;
      w.value = angle / side.flattest;
      w.limit = part_of_angle;
      result.push_back(std::move(w));
    }
  }
  return worst(std::move(result), "bodies");
}

}  // namespace mortise::post
