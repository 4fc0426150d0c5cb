#include "post/contact_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>

#include "contact_patches.hpp"
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

std::vector<Warning> long_slides(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                 std::span<const contact::ContactNodeState> states,
                                 const std::unordered_map<Global, Nodal>& nodes, int dimension, const Communicator& comm)
{
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
  const double corners = dimension;
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

// Of the secondary side to the primary one, which is an obstacle or another body; none of a body in contact with itself.
Point relative_turn(const contact::Pair& pair, const Patch& patch, const std::vector<BodyMotion>& motions)
{
  if (pair.primary && patch.sides[1].body < 0) return Point::Zero();
  const auto rotation = [&](const Facets& side) {
    return side.body < 0 ? Point(Point::Zero()) : motions[static_cast<std::size_t>(side.body)].rigid.rotation;
  };
  return rotation(patch.sides[0]) - rotation(patch.sides[1]);
}

// Whether it is round there, and as narrow as that somewhere.
bool may_roll(const Patch& patch, const Facets& faces)
{
  return faces.body >= 0 && faces.flattest > flat && faces.flattest < edge &&
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

bool is_round(const Facets& side)
{
  return side.body >= 0 && side.round && std::isfinite(side.radius);
}

// The moment of the pressure about the axis of a round side, radius * normal from there: of nothing, where it lies below the
// axis.
Point moment_about_axis(const Patch& patch, const Facets& side)
{
  if (!is_round(side)) return Point::Zero();
  const Point moment = side.radius * patch.normal.cross(side.normals);
  return side.normals.dot(patch.normal) < 0 ? Point(-moment) : moment;
}

// How a round side turns along a direction of its patch.
struct Roll {
  bool sticks;
  double angle, way;    // of its surface
  double width, limit;  // of what presses; of the way over that
  double moment;        // of the pressure of all contacts of the body
};

// Of a round side, which turns by `turn`. `moment`: of all contacts of its body, see moment_about_axis().
std::optional<Roll> roll_of(const Patch& patch, const Facets& side, std::size_t direction, const Point& turn, const Point& moment)
{
  // Of the width that presses. Where it slips friction is what it can be, and all that the lever of the pressure takes is lacking
  // in what holds the body besides: that counts sooner where friction has no large moment either.
  constexpr double part_where_it_sticks = 0.1, part_where_it_slips = 0.05, part_of_large_moment = 0.02, mostly = 0.5;
  constexpr double large_moment = 0.05;  // of that and what friction has
  // Of the way, that the pressure has moved aside, at least and at most, else something else holds it where it is; and of its
  // moment, that is left with the other contacts of the body.
  constexpr double moved = 0.3, farthest = 1.5, left = 0.3;
  const Point axis = patch.normal.cross(patch.directions[direction]);
  Roll roll{.sticks = patch.stuck > mostly * patch.force,
            .angle = std::abs(turn.dot(axis)),
            .way = 0,
            .width = std::max(patch.widths[direction], side.size / 2),
            .limit = 0,
            .moment = -std::copysign(1, turn.dot(axis)) * moment.dot(axis)};  // against the turn
  roll.way = roll.angle * side.radius;
  const bool large = roll.moment > large_moment * (roll.moment + side.radius * patch.shear);
  roll.limit = roll.sticks ? part_where_it_sticks : large ? part_of_large_moment : part_where_it_slips;
  if (!(roll.way > roll.limit * roll.width)) return {};
  if (roll.sticks) return patch.widths[direction] > side.size ? std::optional(roll) : std::nullopt;  // less: see facet_turns
  const double own = -std::copysign(1, turn.dot(axis)) * moment_about_axis(patch, side).dot(axis), whole = roll.way * patch.force;
  if (!(own > moved * whole && own < farthest * whole && roll.moment > left * own)) return {};
  return roll;
}

std::string text_of(const Roll& roll, const std::string& body, const std::string& contact, const Patch& patch)
{
  if (roll.sticks)
    return fmt::format(
        "body \"{}\" rolls by about {:.3g} in contact {} at {}, which presses over {:.3g} that way: it presses where it "
        "stood before, in the direction that it had there, and what it bears along the surface is off by up to {:.3g}",
        body, roll.way, contact, spell(patch.centre), roll.width, patch.force * roll.angle);
  return fmt::format(
      "the surface of body \"{}\" turns by about {:.3g} in contact {} at {}, which presses over {:.3g} that way: the "
      "pressure moves aside with it, where what is round keeps its place, and takes a moment of about {:.3g} from what "
      "holds the body against turning",
      body, roll.way, contact, spell(patch.centre), roll.width, roll.moment);
}

std::vector<Warning> facet_turns(std::span<const contact::Pair> pairs, const mesh::Catalogue& catalogue,
                                 const std::vector<Patch>& patches, const std::vector<BodyMotion>& motions)
{
  constexpr double part_of_angle = 0.005, rigid = 10;
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& patch = patches[c];
    const Point turn = relative_turn(pairs[c], patch, motions);
    for (const auto& side : patch.sides) {
      if (!may_roll(patch, side)) continue;
      const auto& motion = motions[static_cast<std::size_t>(side.body)];
      const double angle = rolls_by(patch, side, turn);
      if (!(angle > part_of_angle * side.flattest) || !(motion.turning > rigid * motion.rest)) continue;
      const auto& name = catalogue.bodies[static_cast<std::size_t>(side.body)].name;
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

std::vector<Warning> rolled_contacts(std::span<const contact::Pair> pairs, const mesh::Catalogue& catalogue,
                                     const std::vector<Patch>& patches, const std::vector<BodyMotion>& motions)
{
  std::vector<Point> moments(motions.size(), Point::Zero());  // of each body
  for (const auto& patch : patches)
    for (const auto& side : patch.sides)
      if (is_round(side)) moments[static_cast<std::size_t>(side.body)] += moment_about_axis(patch, side);
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& patch = patches[c];
    const Point of_secondary = relative_turn(pairs[c], patch, motions);
    for (const auto& side : patch.sides)
      for (std::size_t k = 0; k < patch.directions.size() && is_round(side); ++k) {
        const Point turn = &side == &patch.sides[0] ? of_secondary : Point(-of_secondary);
        const auto roll = roll_of(patch, side, k, turn, moments[static_cast<std::size_t>(side.body)]);
        if (!roll) continue;
        const auto& body = catalogue.bodies[static_cast<std::size_t>(side.body)].name;
        Warning w{"rolled_contact", text_of(*roll, body, pairs[c].options.name, patch),
                  "draw the bodies nearer to where they come to rest, or take no such forces from the results"};
        w.at = patch.centre;
        w.body = body;
        w.contact = pairs[c].options.name;
        w.value = roll->way / roll->width;
        w.limit = roll->limit;
        result.push_back(std::move(w));
      }
  }
  return worst(std::move(result), "bodies");
}

}  // namespace

std::vector<Warning> slides_and_rolls(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                      std::span<const contact::ContactNodeState> states,
                                      const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                                      const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const auto& catalogue = decomposition.catalogue;
  const auto nodes = nodes_at_contact(pairs, contacts, states, decomposition, displacement, comm);
  auto result = long_slides(pairs, contacts, states, nodes, catalogue.dimension, comm);
  if (kinematics == fem::Kinematics::axisymmetric) return result;
  const auto patches = pressing_patches(pairs, contacts, states, nodes, catalogue.dimension, comm);
  if (std::ranges::none_of(patches, [](const Patch& patch) { return patch.force > 0; })) return result;
  const auto motions = rigid_motions(decomposition, kinematics, displacement, comm);
  std::ranges::move(facet_turns(pairs, catalogue, patches, motions), std::back_inserter(result));
  std::ranges::move(rolled_contacts(pairs, catalogue, patches, motions), std::back_inserter(result));
  return result;
}

}  // namespace mortise::post
