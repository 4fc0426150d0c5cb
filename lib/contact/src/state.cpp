#include "contact/state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "by_node.hpp"
#include "overlap.hpp"

namespace mortise::contact {

ContactNodeState state_of(const constraint::ContactNode& point, bool bonded, std::span<const double> multipliers,
                          std::span<const double> jumps, double bound, double slip_bound, double negligible_pressure)
{
  ContactNodeState state;
  state.contact = point.contact;
  state.node = point.node;
  state.area = point.weight * point.area;
  state.cover = point.cover;
  state.normal = point.normal;
  state.force = point.weight * multipliers[0];
  state.force_on_secondary = -state.force * point.normal;
  state.gap = (bound - jumps[0]) / point.weight;
  double tangential = 0;
  for (std::size_t t = 0; t < point.tangents.size(); ++t) {
    state.force_on_secondary -= point.weight * multipliers[t + 1] * point.tangents[t];
    state.slip += jumps[t + 1] / point.weight * point.tangents[t];
    tangential = std::hypot(tangential, multipliers[t + 1]);
  }
  if (bonded)
    state.status = Status::stick;
  else if (state.force > negligible_pressure * point.area)
    state.status = slip_bound > 0 && tangential < slip_bound * (1 - 1e-6) ? Status::stick : Status::slip;
  return state;
}

std::vector<Resultant> resultants(std::span<const ContactNodeState> points, std::size_t contacts, const Communicator& comm)
{
  constexpr std::size_t width = 8;
  std::vector<double> sums(contacts * width, 0.0);
  for (const auto& p : points) {
    double* s = &sums[static_cast<std::size_t>(p.contact) * width];
    for (int c = 0; c < 3; ++c) s[c] += p.force_on_secondary[c];
    if (p.status != Status::open) s[3] += p.area;
    s[4 + static_cast<int>(p.status)] += 1;
    s[7] += p.force_on_secondary.norm();
  }
  comm.sum_in_place(sums);
  std::vector<Resultant> result(contacts);
  for (std::size_t c = 0; c < contacts; ++c) {
    const double* s = &sums[c * width];
    result[c] = {Point(s[0], s[1], s[2]), s[3], std::llround(s[4]), std::llround(s[5]), std::llround(s[6]), s[7]};
  }
  return result;
}

namespace {

// Less cover makes a strip too narrow for a pressure of its own.
constexpr double narrow = 0.35;

// Of the largest pressure: less counts as open, whatever the solver's tolerance leaves.
constexpr double open_part = 1e-4;
// Of the largest pressure on a face: a node with less enters its mean by degrees.
constexpr double entered_part = 0.05;
// A face belongs to the points at its nodes whose normals enclose less than some 40 degrees with its own: beyond a kink are
// others.
constexpr double one_side = 0.75;

// A point at a node of a contact; at a kink there are several, in the order of their normals. Plain bytes. Lives on the node's
// own rank, see by_node().
struct NodeState {
  Global node;
  int contact, side, status;  // side: which of the node's points
  double area, cover, force, gap;
  std::array<double, 3> normal, traction, slip;  // traction: a force until divide_by_areas()
};

auto key(const NodeState& state)
{
  return std::tie(state.node, state.contact, state.side);
}

template <class T>
bool before(const T& a, const NodeState& b)
{
  return std::tie(a.node, a.contact) < std::tie(b.node, b.contact);
}

// A corner of the primary side has a row, but no place in the output: what presses there counts with the node beside it, on the
// same side of a kink. `nodes` are sorted.
void join_corners(std::vector<NodeState>& nodes)
{
  constexpr double one_normal = 0.9;  // cosine
  const auto join = [](NodeState& to, const NodeState& corner) {
    to.area += corner.area;
    to.cover = std::max(to.cover, corner.cover);
    to.force += corner.force;
    for (std::size_t c = 0; c < 3; ++c) to.traction[c] += corner.traction[c];
    if (to.status == static_cast<int>(Status::open)) to.status = corner.status;
  };
  const auto dot = [](const NodeState& a, const NodeState& b) {
    return a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1] + a.normal[2] * b.normal[2];
  };
  std::vector<NodeState> joined;
  for (std::size_t first = 0, end = 0; first < nodes.size(); first = end) {
    while (end < nodes.size() && !before(nodes[first], nodes[end])) ++end;
    const std::size_t begin = joined.size();
    for (const bool corners : {false, true})
      for (std::size_t i = first; i < end; ++i) {
        if ((nodes[i].cover == 0) != corners) continue;
        const auto to = std::find_if(joined.begin() + static_cast<std::ptrdiff_t>(begin), joined.end(),
                                     [&](const NodeState& other) { return corners && dot(other, nodes[i]) > one_normal; });
        if (to == joined.end())
          joined.push_back(nodes[i]);
        else
          join(*to, nodes[i]);
      }
  }
  nodes = std::move(joined);
}

// Those of this rank's own nodes, ascending by node, contact and side. Collective.
std::vector<NodeState> meet(std::span<const ContactNodeState> points, const Communicator& comm)
{
  std::vector<NodeState> mine;
  for (const auto& p : points) {
    const auto &n = p.normal, &f = p.force_on_secondary, &s = p.slip;
    mine.push_back({p.node,
                    p.contact,
                    0,
                    static_cast<int>(p.status),
                    p.area,
                    p.cover,
                    p.force,
                    p.gap,
                    {n[0], n[1], n[2]},
                    {f[0], f[1], f[2]},
                    {s[0], s[1], s[2]}});
  }
  auto nodes = by_node<NodeState>(mine, comm);
  std::stable_sort(nodes.begin(), nodes.end(), [](const NodeState& a, const NodeState& b) {
    return std::tie(a.node, a.contact, a.normal) < std::tie(b.node, b.contact, b.normal);
  });
  join_corners(nodes);
  for (std::size_t i = 1; i < nodes.size(); ++i)
    if (!before(nodes[i - 1], nodes[i])) nodes[i].side = nodes[i - 1].side + 1;
  return nodes;
}

// All points at a node, of ascending ones.
template <class Nodes>
auto points_at(Nodes& nodes, int contact, Global node)
{
  NodeState wanted{};
  wanted.contact = contact;
  wanted.node = node;
  const auto [first, last] = std::equal_range(nodes.begin(), nodes.end(), wanted, before<NodeState>);
  return std::span(first, last);
}

// That at a node of a face with this normal, or null; of a single point without a normal that one.
const NodeState* point_of(const std::vector<NodeState>& nodes, int contact, Global node, const Point& face_normal)
{
  const NodeState* best = nullptr;
  double most = one_side;
  for (const auto& state : points_at(nodes, contact, node)) {
    const Point normal(state.normal[0], state.normal[1], state.normal[2]);
    const double cosine = normal.isZero(0) ? 1 : normal.dot(face_normal);
    if (cosine > most) most = cosine, best = &state;
  }
  return best;
}

// What the nodes of this rank's secondary sides are, ascending. Collective.
std::vector<NodeState> on_sides(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm)
{
  std::vector<Global> wanted;
  for (const auto& pair : pairs) wanted.insert(wanted.end(), pair.secondary.node_id.begin(), pair.secondary.node_id.end());
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  auto result = answer(nodes, ask(wanted, comm), comm);
  std::sort(result.begin(), result.end(), [](const NodeState& a, const NodeState& b) { return key(a) < key(b); });
  return result;
}

// What passes between a node with little cover and one of its neighbours with more; lives on the rank of `node`, one of the two.
struct Given {
  Global node;
  int contact, side;
  Global other;
  int other_side;
  double part;         // of what the narrow one has; at first the area of the wide one
  double area, force;  // that pass
  std::array<double, 3> traction;
};

bool ascending(const Given& a, const Given& b)
{
  return std::tie(a.node, a.contact, a.side, a.other, a.other_side) < std::tie(b.node, b.contact, b.side, b.other, b.other_side);
}

// The narrow or the wide one's state, whichever lives here.
NodeState& state_of(std::vector<NodeState>& nodes, const Given& given)
{
  return points_at(nodes, given.contact, given.node)[static_cast<std::size_t>(given.side)];
}

// Each pair of neighbours once, on the rank of the narrow node. Collective.
std::vector<Given> neighbours(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm)
{
  const auto known = on_sides(nodes, pairs, comm);
  std::vector<Given> found;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& surface = pairs[c].secondary;
    std::vector<const NodeState*> here;  // of the nodes of a face
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const Point normal = corners_of(surface, f).normal();
      here.clear();
      for (const Local n : surface.faces[f])
        here.push_back(point_of(known, static_cast<int>(c), surface.node_id[static_cast<std::size_t>(n)], normal));
      for (const auto* from : here)
        for (const auto* to : here)
          if (from && to && from->cover < narrow && to->cover >= narrow)
            found.push_back({from->node, from->contact, from->side, to->node, to->side, to->area, 0, 0, {0, 0, 0}});
    }
  }
  found = by_node<Given>(found, comm);
  std::sort(found.begin(), found.end(), ascending);
  const auto same = [](const Given& a, const Given& b) { return !ascending(a, b) && !ascending(b, a); };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

// The same on the ranks of the other nodes. Collective.
std::vector<Given> turned_round(std::vector<Given> given, const Communicator& comm)
{
  for (auto& g : given) {
    std::swap(g.node, g.other);
    std::swap(g.side, g.other_side);
  }
  given = by_node<Given>(given, comm);
  std::sort(given.begin(), given.end(), ascending);
  return given;
}

// Turns forces into pressures and tractions. What has little cover gives force and area to its neighbours, by their areas, and
// takes their mean. Collective.
void divide_by_areas(std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm)
{
  auto given = neighbours(nodes, pairs, comm);
  for (auto first = given.begin(); first != given.end();) {
    const NodeState& from = state_of(nodes, *first);
    auto end = first;
    double area = 0;  // of all neighbours
    for (; end != given.end() && &state_of(nodes, *end) == &from; ++end) area += end->part;
    for (; first != end; ++first) {
      first->part /= area;
      first->area = first->part * from.area;
      first->force = first->part * from.force;
      for (int c = 0; c < 3; ++c) first->traction[c] = first->part * from.traction[c];
    }
  }
  auto taken = turned_round(given, comm);
  for (const auto& g : taken) {
    auto& to = state_of(nodes, g);
    to.area += g.area;
    to.force += g.force;
    for (int c = 0; c < 3; ++c) to.traction[c] += g.traction[c];
  }
  for (auto& node : nodes) {
    node.force /= node.area;
    for (double& traction : node.traction) traction /= node.area;
  }
  for (auto& g : taken) {
    const auto& wide = state_of(nodes, g);
    g.force = g.part * wide.force;
    for (int c = 0; c < 3; ++c) g.traction[c] = g.part * wide.traction[c];
  }
  for (const auto& g : given) {
    auto& node = state_of(nodes, g);
    node.force = 0;
    for (double& traction : node.traction) traction = 0;
  }
  for (const auto& g : turned_round(taken, comm)) {
    auto& node = state_of(nodes, g);
    node.force += g.force;
    for (int c = 0; c < 3; ++c) node.traction[c] += g.traction[c];
  }
}

// The mean over the faces at each pressed node of the means of their pressed nodes: a contact one cell wide keeps its pressure,
// and the border of a contact stays where it is. A node that begins to press enters by degrees, so that the mean does not jump as
// a load grows. At a kink the larger one of its sides. `states`: of the nodes of the surface.
// Collective.
std::vector<double> averaged_over_faces(const mesh::Surface& surface, int contact, const std::vector<NodeState>& states,
                                        const std::vector<double>& pressure, const Communicator& comm)
{
  struct Sums {
    Global node;
    int side;
    double force, area;
  };
  const auto before = [](const Sums& a, const Sums& b) { return std::tie(a.node, a.side) < std::tie(b.node, b.side); };
  double least = 0;
  for (const double p : pressure) least = std::max(least, p);
  least = comm.max(least) * open_part;
  std::vector<Sums> mine;
  std::vector<const NodeState*> pressed;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto corners = corners_of(surface, f);
    const Point normal = corners.normal();
    double highest = 0, sum = 0, count = 0;
    pressed.clear();
    for (const Local n : surface.faces[f])
      if (const auto* state = point_of(states, contact, surface.node_id[static_cast<std::size_t>(n)], normal);
          state && state->force > least) {
        highest = std::max(highest, state->force);
        pressed.push_back(state);
      }
    if (pressed.empty()) continue;
    for (const auto* state : pressed) {
      const double share = std::min(1.0, state->force / (entered_part * highest));
      sum += share * state->force;
      count += share;
    }
    const double size = corners.area() * count / static_cast<double>(surface.faces[f].size());
    for (const auto* state : pressed) mine.push_back({state->node, state->side, size * sum / count, size});
  }
  auto met = by_node<Sums>(mine, comm);
  std::stable_sort(met.begin(), met.end(), before);
  std::vector<Sums> totals;
  for (const auto& part : met) {
    if (totals.empty() || before(totals.back(), part)) {
      totals.push_back(part);
    } else {
      totals.back().force += part.force;
      totals.back().area += part.area;
    }
  }
  auto found = answer(totals, ask(surface.node_id, comm), comm);
  std::sort(found.begin(), found.end(), before);
  std::vector<double> result;
  for (std::size_t i = 0; i < surface.node_id.size(); ++i) {
    double largest = 0;
    for (auto at = std::lower_bound(found.begin(), found.end(), Sums{surface.node_id[i], 0, 0, 0}, before);
         at != found.end() && at->node == surface.node_id[i]; ++at)
      largest = std::max(largest, at->force / at->area);
    result.push_back(pressure[i] > 0 && largest == 0 ? pressure[i] : largest);  // no face looks the way of the contact
  }
  return result;
}

}  // namespace

std::vector<SurfaceState> surface_states(std::span<const ContactNodeState> points, std::span<const Pair> pairs,
                                         const Communicator& comm)
{
  auto own = meet(points, comm);
  divide_by_areas(own, pairs, comm);
  const auto all = on_sides(own, pairs, comm);
  std::vector<SurfaceState> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& nodes = pairs[c].secondary.node_id;
    SurfaceState state{std::vector<double>(nodes.size(), 0.0),
                       std::vector<double>(nodes.size(), 0.0),
                       {},
                       std::vector<Point>(nodes.size(), Point::Zero()),
                       std::vector<Point>(nodes.size(), Point::Zero()),
                       std::vector<int>(nodes.size(), 0),
                       std::vector<char>(nodes.size(), 0)};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto here = points_at(all, static_cast<int>(c), nodes[i]);
      if (here.empty()) continue;
      const auto node = std::max_element(here.begin(), here.end(), [](const NodeState& a, const NodeState& b) {
        return std::pair(a.force, -a.gap) < std::pair(b.force, -b.gap);
      });
      state.near[i] = 1;
      state.pressure[i] = node->force;
      state.traction[i] = Point(node->traction[0], node->traction[1], node->traction[2]);
      state.gap[i] = node->gap;
      state.slip[i] = Point(node->slip[0], node->slip[1], node->slip[2]);
      state.status[i] = node->status;
    }
    state.recovered_pressure = averaged_over_faces(pairs[c].secondary, static_cast<int>(c), all, state.pressure, comm);
    result.push_back(std::move(state));
  }
  return result;
}

}  // namespace mortise::contact
