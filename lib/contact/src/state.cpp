#include "contact/state.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "overlap.hpp"

namespace mortise::contact {

PointState state_of(const constraint::ContactPoint& point, bool bonded, std::span<const double> multipliers,
                    std::span<const double> jumps, double bound, double limit, double nothing)
{
  PointState state;
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
    state.status = limit > 0 && tangential < limit * (1 - 1e-6) ? Status::stick : Status::slip;
  return state;
}

std::vector<Resultant> resultants(std::span<const PointState> points, std::size_t contacts, const Communicator& comm)
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

// A PointState as plain bytes.
struct Sent {
  int contact, status;
  Global node;
  double area, cover, force, gap;
  double traction[3], slip[3];
};

// All points at a node of a contact.
struct NodeState {
  int contact, status;
  Global node;
  double area, cover, force, gap;  // gap and slip times area until all points are there
  Point traction, slip;            // traction: a force
};

bool before(const NodeState& a, const NodeState& b)
{
  return std::tie(a.contact, a.node) < std::tie(b.contact, b.node);
}

// Of all ranks, ascending. Collective.
std::vector<NodeState> gather(std::span<const PointState> points, const Communicator& comm)
{
  std::vector<Sent> mine;
  for (const auto& p : points) {
    const auto &f = p.force_on_secondary, &s = p.slip;
    mine.push_back(
        {p.contact, static_cast<int>(p.status), p.node, p.area, p.cover, p.force, p.gap, {f[0], f[1], f[2]}, {s[0], s[1], s[2]}});
  }
  std::vector<NodeState> all;
  for (const auto& p : comm.all_gather(mine))
    all.push_back({p.contact, p.status, p.node, p.area, p.cover, p.force, p.gap * p.area,
                   Point(p.traction[0], p.traction[1], p.traction[2]), Point(p.slip[0], p.slip[1], p.slip[2]) * p.area});
  std::stable_sort(all.begin(), all.end(), before);
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
    node.traction += p.traction;
    node.slip += p.slip;
  }
  for (auto& node : nodes) {
    node.gap /= node.area;
    node.slip /= node.area;
  }
  return nodes;
}

const NodeState* find(const std::vector<NodeState>& nodes, int contact, Global node)
{
  NodeState wanted{};
  wanted.contact = contact;
  wanted.node = node;
  const auto found = std::lower_bound(nodes.begin(), nodes.end(), wanted, before);
  return found != nodes.end() && !before(wanted, *found) ? &*found : nullptr;
}

// A node with little cover, and one of its neighbours with more; places in the list of all.
struct Neighbour {
  std::size_t narrow, wide;
  friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
};

// Ascending. Collective.
std::vector<Neighbour> neighbours(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm)
{
  std::vector<Neighbour> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& surface = pairs[c].secondary;
    std::vector<const NodeState*> here;
    for (const Global node : surface.node_id) here.push_back(find(nodes, static_cast<int>(c), node));
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
      for (const Local a : surface.faces[f])
        for (const Local b : surface.faces[f]) {
          const auto *from = here[static_cast<std::size_t>(a)], *to = here[static_cast<std::size_t>(b)];
          if (from && to && from->cover < narrow && to->cover >= narrow)
            result.push_back({static_cast<std::size_t>(from - nodes.data()), static_cast<std::size_t>(to - nodes.data())});
        }
  }
  result = comm.all_gather(result);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Turns forces into pressures and tractions. What has little cover gives force and area to its neighbours, by their areas, and
// takes their mean. Collective.
void divide_by_areas(std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm)
{
  const auto given = neighbours(nodes, pairs, comm);
  std::vector<double> areas(nodes.size(), 0.0);  // of all neighbours of a narrow node
  for (const auto& g : given) areas[g.narrow] += nodes[g.wide].area;
  const auto before_giving = nodes;
  for (const auto& g : given) {
    const auto& from = before_giving[g.narrow];
    auto& to = nodes[g.wide];
    const double part = before_giving[g.wide].area / areas[g.narrow];
    to.area += part * from.area;
    to.force += part * from.force;
    to.traction += part * from.traction;
  }
  for (auto& node : nodes) {
    node.force /= node.area;
    node.traction /= node.area;
  }
  for (const auto& g : given) nodes[g.narrow].force = 0, nodes[g.narrow].traction.setZero();
  for (const auto& g : given) {
    const double part = before_giving[g.wide].area / areas[g.narrow];
    nodes[g.narrow].force += part * nodes[g.wide].force;
    nodes[g.narrow].traction += part * nodes[g.wide].traction;
  }
}

}  // namespace

namespace {

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
  auto all = comm.all_gather(mine);
  std::stable_sort(all.begin(), all.end(), [](const Sums& a, const Sums& b) { return a.node < b.node; });
  std::vector<double> result;
  auto at = all.begin();
  for (std::size_t i = 0; i < surface.node_id.size(); ++i) {
    const Global node = surface.node_id[i];
    at = std::lower_bound(at, all.end(), node, [](const Sums& sums, Global wanted) { return sums.node < wanted; });
    Sums total{node, 0, 0};
    for (auto part = at; part != all.end() && part->node == node; ++part) {
      total.force += part->force;
      total.area += part->area;
    }
    result.push_back(pressure[i] > 0 && total.area > 0 ? total.force / total.area : 0.0);
  }
  return result;
}

}  // namespace

std::vector<SurfaceState> surface_states(std::span<const PointState> points, std::span<const Pair> pairs,
                                         const Communicator& comm)
{
  auto all = gather(points, comm);
  divide_by_areas(all, pairs, comm);
  std::vector<SurfaceState> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& nodes = pairs[c].secondary.node_id;
    SurfaceState state{std::vector<double>(nodes.size(), 0.0),
                       std::vector<double>(nodes.size(), 0.0),
                       {},
                       std::vector<Point>(nodes.size(), Point::Zero()),
                       std::vector<Point>(nodes.size(), Point::Zero()),
                       std::vector<int>(nodes.size(), 0)};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto* node = find(all, static_cast<int>(c), nodes[i]);
      if (!node) continue;
      state.pressure[i] = node->force;
      state.traction[i] = node->traction;
      state.gap[i] = node->gap;
      state.slip[i] = node->slip;
      state.status[i] = node->status;
    }
    state.recovered_pressure = averaged_over_faces(pairs[c].secondary, state.pressure, comm);
    result.push_back(std::move(state));
  }
  return result;
}

}  // namespace mortise::contact
