#include "post/contact_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "base/dense.hpp"
#include "contact_nodes.hpp"
#include "post/drift.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

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

constexpr double flat = 1e-3;  // radians from face to face

// The faces at what presses, of one side: the angle between two of them where the surface is flattest, at nodes between corners
// none; at corners its smallest radius, and whether it is round at all of them; their size, whose they are.
struct Facets {
  double flattest = std::numeric_limits<double>::infinity(), radius = flattest, size = 0;
  int body = -1;
  bool round = true;

  void take(const Nodal& node)
  {
    flattest = std::min(flattest, node.angle());
    if (!node.corner) return;
    const double angle = node.angle();
    round = round && angle > flat;
    if (angle > flat) radius = std::min(radius, node.size / angle);
    size = std::max(size, node.size);
    body = std::max(body, node.body);
  }
};

// Where a contact presses: how far along two directions of its surface (one in planes), of which the first is the narrowest, and
// on which faces of its secondary and its primary side. `stuck`: the part of the force at points that stick.
struct Patch {
  double force = 0, stuck = 0;
  Point normal = Point::Zero(), centre = Point::Zero();
  std::vector<Point> directions = {};
  std::vector<double> widths = {};
  std::array<Facets, 2> sides = {};
};

struct Moments {
  double force = 0, stuck = 0;
  Point normal = Point::Zero(), first = Point::Zero();  // times the force, as all that follows
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};
static_assert(sizeof(Moments) == sizeof(double) * 17);

Patch patch_of(const Moments& moments, int dimension)
{
  if (!(moments.force > 0)) return {};
  const Point n = moments.normal.normalized(), centre = moments.first / moments.force;
  Patch patch{moments.force, moments.stuck, n, centre};
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
      if (touches(pairs, states[i]) && states[i].force > presses * largest[c])
        visit(c, contacts.nodes[i], states[i].force, states[i].status == contact::Status::stick);
    }
  };
  for_each_point([&](std::size_t c, const auto&, double force, bool) { largest[c] = std::max(largest[c], force); });
  for (auto& force : largest) force = comm.max(force);
  std::vector<Moments> moments(pairs.size());
  for_each_point([&](std::size_t c, const constraint::ContactNode& point, double force, bool sticks) {
    moments[c].force += force;
    if (sticks) moments[c].stuck += force;
    moments[c].normal += force * point.normal;
    moments[c].first += force * point.at;
    moments[c].second += force * point.at * point.at.transpose();
  });
  comm.sum_in_place({reinterpret_cast<double*>(moments.data()), moments.size() * 17});
  std::vector<Patch> result;
  for (const auto& sums : moments) result.push_back(patch_of(sums, dimension));
  std::vector<std::array<double, 4>> ends(pairs.size());  // of each direction minus the least place and the largest
  for (auto& end : ends) end.fill(-std::numeric_limits<double>::infinity());
  for_each_point([&](std::size_t c, const constraint::ContactNode& point, double, bool) {
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
      side.radius = -comm.max(-side.radius);
      side.round = !comm.any(!side.round);
      side.size = comm.max(side.size);
      side.body = static_cast<int>(comm.max(static_cast<double>(side.body)));
    }
  }
  return result;
}

// Of the secondary side to the primary one.
Point relative_turn(const Patch& patch, const std::vector<BodyMotion>& motions)
{
  const auto rotation = [&](const Facets& side) {
    return side.body < 0 ? Point(Point::Zero()) : motions[static_cast<std::size_t>(side.body)].rigid.rotation;
  };
  return rotation(patch.sides[0]) - rotation(patch.sides[1]);
}

// Whether it is round there, and as narrow as that somewhere.
bool may_roll(const Patch& patch, const Facets& faces)
{
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
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& patch = patches[c];
    const Point turn = relative_turn(patch, motions);
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

std::vector<Warning> rolled_contacts(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                     std::span<const contact::ContactNodeState> states,
                                     const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                                     const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  constexpr double part_of_width = 0.1, mostly = 0.5;
  if (kinematics == fem::Kinematics::axisymmetric) return {};
  const auto nodes = nodes_at_contact(pairs, contacts, states, decomposition, displacement, comm);
  const auto patches = pressing_patches(pairs, contacts, states, nodes, decomposition.catalogue.dimension, comm);
  const auto sticks = [&](const Patch& patch) { return patch.force > 0 && patch.stuck > mostly * patch.force; };
  if (std::ranges::none_of(patches, sticks)) return {};
  const auto motions = rigid_motions(decomposition, kinematics, displacement, comm);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& patch = patches[c];
    if (!sticks(patch)) continue;
    const Point turn = relative_turn(patch, motions);
    for (const auto& side : patch.sides)
      for (std::size_t k = 0; k < patch.directions.size(); ++k) {
        if (side.body < 0 || !side.round || !std::isfinite(side.radius)) continue;
        const double angle = std::abs(turn.dot(patch.normal.cross(patch.directions[k])));
        const double way = angle * side.radius;
        if (!(patch.widths[k] > side.size) || !(way > part_of_width * patch.widths[k])) continue;  // narrower ones: facet_turns
        const auto& name = decomposition.catalogue.bodies[static_cast<std::size_t>(side.body)].name;
        Warning w{
            "rolled_contact",
            fmt::format("body \"{}\" rolls by about {:.3g} in contact {} at {}, which presses over {:.3g} that way: it presses "
                        "where it stood before, in the direction that it had there, and what it bears along the surface is "
                        "off by up to {:.3g}",
                        name, way, pairs[c].options.name, spell(patch.centre), patch.widths[k], patch.force * angle),
            "draw the bodies nearer to where they come to rest, or take no forces along the surface from it"};
        w.at = patch.centre;
        w.body = name;
        w.contact = pairs[c].options.name;
        w.value = way / patch.widths[k];
        w.limit = part_of_width;
        result.push_back(std::move(w));
      }
  }
  return worst(std::move(result), "bodies");
}

}  // namespace mortise::post
