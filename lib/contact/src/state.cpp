#include "contact/state.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "by_node.hpp"
#include "overlap.hpp"

namespace mortise::contact {

ContactNodeState state_of(const constraint::ContactNode& point, bool bonded, std::span<const double> multipliers,
                          std::span<const double> jumps, double bound, double slip_bound, double nothing)
{
  ContactNodeState state;
  state.contact = point.contact;
  state.node = point.node;
  state.area = point.area;
  state.cover = point.cover;
  state.force = multipliers[0];
  state.force_on_secondary = -point.weight * multipliers[0] * point.normal;
  state.gap = bound - jumps[0];
  double tangential = 0;
  for (std::size_t t = 0; t < point.tangents.size(); ++t) {
    state.force_on_secondary -= point.weight * multipliers[t + 1] * point.tangents[t];
    state.slip += jumps[t + 1] * point.tangents[t];
    tangential = std::hypot(tangential, multipliers[t + 1]);
  }
  if (bonded)
    state.status = Status::stick;
  else if (state.force > nothing * point.area)
    state.status = slip_bound > 0 && tangential < slip_bound * (1 - 1e-6) ? Status::stick : Status::slip;
  return state;
}

std::vector<Resultant> resultants(std::span<const ContactNodeState> points, std::size_t contacts, const Communicator& comm)
{
  constexpr std::size_t width = 7;
  std::vector<double> sums(contacts * width, 0.0);
  for (const auto& p : points) {
    double* s = &sums[static_cast<std::size_t>(p.contact) * width];
    for (int c = 0; c < 3; ++c) s[c] += p.force_on_secondary[c];
    if (p.status != Status::open) s[3] += p.area;
    s[4 + static_cast<int>(p.status)] += 1;
  }
  comm.sum_in_place(sums);
  std::vector<Resultant> result(contacts);
  for (std::size_t c = 0; c < contacts; ++c) {
    const double* s = &sums[c * width];
    result[c] = {Point(s[0], s[1], s[2]), s[3], std::llround(s[4]), std::llround(s[5]), std::llround(s[6])};
  }
  return result;
}

namespace {

// Less cover makes a strip too narrow for a pressure of its own.
constexpr double narrow = 0.35;

// All points at a node of a contact; plain bytes. Lives on the node's own rank, see by_node().
struct NodeState {
  Global node;
  int contact, status;
  double area, cover, force, gap;  // gap and slip times area until all points are there
  double traction[3], slip[3];     // traction: a force
};

template <class T>
bool before(const T& a, const NodeState& b)
{
  return std::tie(a.node, a.contact) < std::tie(b.node, b.contact);
}

// Those of this rank's own nodes, ascending by node and contact. Collective.
std::vector<NodeState> meet(std::span<const ContactNodeState> points, const Communicator& comm)
{
  std::vector<NodeState> mine;
  for (const auto& p : points) {
    const auto &f = p.force_on_secondary, &s = p.slip;
    mine.push_back({p.node,
                    p.contact,
                    static_cast<int>(p.status),
                    p.area,
                    p.cover,
                    p.force,
                    p.gap * p.area,
                    {f[0], f[1], f[2]},
                    {s[0] * p.area, s[1] * p.area, s[2] * p.area}});
  }
  auto all = by_node<NodeState>(mine, comm);
  std::stable_sort(all.begin(), all.end(), before<NodeState>);
  std::vector<NodeState> nodes;
  for (const auto& p : all) {
    if (nodes.empty() || before(nodes.back(), p)) {
      nodes.push_back(p);
      continue;
    }
    auto& node = nodes.back();  // at a kink
    node.status = std::max(node.status, p.status);
    node.cover = std::max(node.cover, p.cover);
    node.area += p.area;
    node.force += p.force;
    node.gap += p.gap;
    for (int c = 0; c < 3; ++c) {
      node.traction[c] += p.traction[c];
      node.slip[c] += p.slip[c];
    }
  }
  for (auto& node : nodes) {
    node.gap /= node.area;
    for (double& slip : node.slip) slip /= node.area;
  }
  return nodes;
}

// Of ascending ones.
template <class Nodes>
auto* find(Nodes& nodes, int contact, Global node)
{
  NodeState wanted{};
  wanted.contact = contact;
  wanted.node = node;
  const auto found = std::lower_bound(nodes.begin(), nodes.end(), wanted, before<NodeState>);
  return found != nodes.end() && !before(wanted, *found) ? &*found : nullptr;
}

// What the nodes of this rank's secondary sides are, ascending. Collective.
std::vector<NodeState> on_sides(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm)
{
  std::vector<Global> wanted;
  for (const auto& pair : pairs) wanted.insert(wanted.end(), pair.secondary.node_id.begin(), pair.secondary.node_id.end());
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  auto result = answer(nodes, ask(wanted, comm), comm);
  std::sort(result.begin(), result.end(), before<NodeState>);
  return result;
}

// What passes between a node with little cover and one of its neighbours with more; lives on the rank of `node`, one of the two.
struct Given {
  Global node;
  int contact;
  Global other;
  double part;                      // of what the narrow one has; at first the area of the wide one
  double area, force, traction[3];  // that pass
};

bool ascending(const Given& a, const Given& b)
{
  return std::tie(a.node, a.contact, a.other) < std::tie(b.node, b.contact, b.other);
}

// Each pair of neighbours once, on the rank of the narrow node. Collective.
std::vector<Given> neighbours(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm)
{
  const auto known = on_sides(nodes, pairs, comm);
  std::vector<Given> found;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& surface = pairs[c].secondary;
    std::vector<const NodeState*> here;
    for (const Global node : surface.node_id) here.push_back(find(known, static_cast<int>(c), node));
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
      for (const Local a : surface.faces[f])
        for (const Local b : surface.faces[f]) {
          const auto *from = here[static_cast<std::size_t>(a)], *to = here[static_cast<std::size_t>(b)];
          if (from && to && from->cover < narrow && to->cover >= narrow)
            found.push_back({from->node, from->contact, to->node, to->area, 0, 0, {0, 0, 0}});
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
  for (auto& g : given) std::swap(g.node, g.other);
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
    const NodeState& from = *find(nodes, first->contact, first->node);
    auto end = first;
    double area = 0;  // of all neighbours
    for (; end != given.end() && end->node == first->node && end->contact == first->contact; ++end) area += end->part;
    for (; first != end; ++first) {
      first->part /= area;
      first->area = first->part * from.area;
      first->force = first->part * from.force;
      for (int c = 0; c < 3; ++c) first->traction[c] = first->part * from.traction[c];
    }
  }
  auto taken = turned_round(given, comm);
  for (const auto& g : taken) {
    auto& to = *find(nodes, g.contact, g.node);
    to.area += g.area;
    to.force += g.force;
    for (int c = 0; c < 3; ++c) to.traction[c] += g.traction[c];
  }
  for (auto& node : nodes) {
    node.force /= node.area;
    for (double& traction : node.traction) traction /= node.area;
  }
  for (auto& g : taken) {
    const auto& wide = *find(nodes, g.contact, g.node);
    g.force = g.part * wide.force;
    for (int c = 0; c < 3; ++c) g.traction[c] = g.part * wide.traction[c];
  }
  for (const auto& g : given) {
    auto& node = *find(nodes, g.contact, g.node);
    node.force = 0;
    for (double& traction : node.traction) traction = 0;
  }
  for (const auto& g : turned_round(taken, comm)) {
    auto& node = *find(nodes, g.contact, g.node);
    node.force += g.force;
    for (int c = 0; c < 3; ++c) node.traction[c] += g.traction[c];
  }
}

// The mean over the faces at each pressed node of the means of their pressed nodes: a contact one cell wide keeps its pressure,
// and the border of a contact stays where it is. Collective.
std::vector<double> averaged_over_faces(const mesh::Surface& surface, const std::vector<double>& pressure,
                                        const Communicator& comm)
{
  struct Sums {
    Global node;
    double force, area;
  };
  std::vector<Sums> mine;
  for (const Global node : surface.node_id) mine.push_back({node, 0, 0});
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    double sum = 0;
    int count = 0;
    for (const Local n : surface.faces[f]) {
      if (!(pressure[static_cast<std::size_t>(n)] > 0)) continue;
      sum += pressure[static_cast<std::size_t>(n)];
      ++count;
    }
    if (count == 0) continue;
    const double size = corners_of(surface, f).area() * count / static_cast<double>(surface.faces[f].size());
    for (const Local n : surface.faces[f]) {
      mine[static_cast<std::size_t>(n)].force += size * sum / count;
      mine[static_cast<std::size_t>(n)].area += size;
    }
  }
  std::vector<Sums> totals;
  for (const auto& part : by_node<Sums>(mine, comm)) {
    if (totals.empty() || totals.back().node != part.node) {
      totals.push_back(part);
    } else {
      totals.back().force += part.force;
      totals.back().area += part.area;
    }
  }
  const auto found = answer(totals, ask(surface.node_id, comm), comm);
  std::vector<double> result;
  for (std::size_t i = 0; i < surface.node_id.size(); ++i) {
    const auto total = std::lower_bound(found.begin(), found.end(), surface.node_id[i],
                                        [](const Sums& sums, Global wanted) { return sums.node < wanted; });
    result.push_back(pressure[i] > 0 && total->area > 0 ? total->force / total->area : 0.0);
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
      const auto* node = find(all, static_cast<int>(c), nodes[i]);
      if (!node) continue;
      state.near[i] = 1;
      state.pressure[i] = node->force;
      state.traction[i] = Point(node->traction[0], node->traction[1], node->traction[2]);
      state.gap[i] = node->gap;
      state.slip[i] = Point(node->slip[0], node->slip[1], node->slip[2]);
      state.status[i] = node->status;
    }
    state.recovered_pressure = averaged_over_faces(pairs[c].secondary, state.pressure, comm);
    result.push_back(std::move(state));
  }
  return result;
}

}  // namespace mortise::contact
