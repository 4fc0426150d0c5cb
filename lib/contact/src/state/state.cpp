#include "contact/state.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "integrals/overlap.hpp"
#include "rows/by_node.hpp"
#include "state/narrow_nodes.hpp"
#include "state/node_state.hpp"

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
  state.parts = point.parts;
  state.force = point.in_surface ? 0 : point.weight * multipliers[0];
  state.force_on_secondary = -point.weight * multipliers[0] * point.normal;
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

std::vector<ContactNodeState> with_images(std::vector<ContactNodeState> states, std::span<const constraint::ContactNode> nodes)
{
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto take = [](ContactNodeState& state, double part) {
      state.area *= part, state.force *= part, state.force_on_secondary *= part;
    };
    double own = 1;
    for (const auto& image : nodes[i].images) {
      auto state = states[i];
      state.contact = image.contact;
      state.node = image.node;
      if (!state.parts.empty()) {
        state.parts = {{image.node, 1, image.rotation * state.normal}};
        if (image.part < bears / 2) state.status = Status::open;
      }
      for (Point* vector : {&state.normal, &state.force_on_secondary, &state.slip}) *vector = image.rotation * *vector;
      take(state, image.part);
      own -= image.part;
      states.push_back(std::move(state));
    }
    if (!nodes[i].images.empty()) take(states[i], own);
  }
  return states;
}

std::vector<Resultant> resultants(std::span<const ContactNodeState> states, std::size_t contacts, const Communicator& comm)
{
  constexpr std::size_t width = 8;
  std::vector<double> sums(contacts * width, 0.0);
  for (const auto& p : states) {
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

// Of the largest pressure: less counts as open, whatever the solver's tolerance leaves.
constexpr double open_part = 1e-4;
// Of the largest pressure on a face: a node with less enters its mean by degrees.
constexpr double entered_part = 0.05;

// How much the k-th node of a face counts in its mean: none that is open, unless it stands in the middle of nodes that press.
// `here`: of all its nodes, or null.
double share_of(mesh::CellType type, std::span<const NodeState* const> here, std::size_t k, double least, double entered)
{
  const double part = std::min(1.0, 2 * here[k]->cover);
  if (const auto corners = static_cast<std::size_t>(mesh::corner_count(type)); k >= corners) {
    const auto& ends = mesh::middles(type)[k - corners];
    const auto presses = [&](int c) {
      const auto* end = here[static_cast<std::size_t>(c)];
      return end && end->force > least;
    };
    if (std::all_of(ends.begin(), ends.end(), presses)) return part;
  }
  return here[k]->force > least ? part * std::min(1.0, here[k]->force / entered) : 0;
}

// What a face gives to the mean at one of its nodes; on the node's rank at last.
struct FaceMean {
  Global node;
  int contact, side;
  double force, area;
};

// The means of the faces of a contact's side. `least`: what counts as open.
void add_means(const mesh::Surface& surface, int contact, const std::vector<NodeState>& states, double least,
               std::vector<FaceMean>& means)
{
  std::vector<const NodeState*> here;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto corners = corners_of(surface, f);
    const Point normal = corners.normal();
    double highest = 0, sum = 0, count = 0;
    here.clear();
    for (const Local n : surface.faces[f]) {
      here.push_back(point_of(states, contact, surface.node_id[static_cast<std::size_t>(n)], normal));
      if (here.back()) highest = std::max(highest, here.back()->force);
    }
    if (!(highest > least)) continue;
    for (std::size_t k = 0; k < here.size(); ++k) {
      if (!here[k]) continue;
      const double share = share_of(surface.faces.type[f], here, k, least, entered_part * highest);
      sum += share * here[k]->force;
      count += share;
      if (share == 0) here[k] = nullptr;
    }
    const double size = corners.area() * count / static_cast<double>(surface.faces[f].size());
    for (const auto* state : here)
      if (state) means.push_back({state->node, contact, state->side, size * sum / count, size});
  }
}

// The mean over the faces at each pressed node of the means of their pressed nodes: a contact one cell wide keeps its pressure,
// and the border of a contact stays where it is. A node that begins to press enters by degrees, so that the mean does not jump as
// a load grows; one of which less than half is covered counts as much less. `own`: with their pressures. Collective.
void average_over_faces(std::vector<NodeState>& own, std::span<const Pair> pairs, const Communicator& comm)
{
  const auto all = on_sides(own, pairs, comm);
  std::vector<double> largest(pairs.size(), 0.0);
  for (const auto& node : own)
    largest[static_cast<std::size_t>(node.contact)] = std::max(largest[static_cast<std::size_t>(node.contact)], node.force);
  std::vector<FaceMean> means;
  for (std::size_t c = 0; c < pairs.size(); ++c)
    add_means(pairs[c].secondary, static_cast<int>(c), all, comm.max(largest[c]) * open_part, means);
  means = by_node<FaceMean>(means, comm);
  std::vector<double> area(own.size(), 0.0);
  for (const auto& mean : means) {
    auto& node = points_at(own, mean.contact, mean.node)[static_cast<std::size_t>(mean.side)];
    node.recovered += mean.force;
    area[static_cast<std::size_t>(&node - own.data())] += mean.area;
  }
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (area[i] > 0)
      own[i].recovered /= area[i];
    else
      own[i].recovered = std::max(own[i].force, 0.0);  // no face looks the way of the contact
  }
}

// Where all points at a kink stick, their tractions may oppose each other by any amount: bodies feel the sum alone. A stress in
// the body leaves t_i = sigma n_i, which differ from their mean by about its size times the tangent of what normals lean by from
// theirs. So by no more than that.
void limit_opposing_tractions(std::vector<NodeState>& own)
{
  using Normal = Eigen::Map<const Point>;
  constexpr double rounding_of_motion = 1e-7;  // of the size of a face
  for (std::size_t first = 0, end = 0; first < own.size(); first = end) {
    while (end < own.size() && own[end].node == own[first].node && own[end].contact == own[first].contact) ++end;
    const std::span points(own.begin() + static_cast<std::ptrdiff_t>(first), end - first);
    const auto sticks = [](const NodeState& p) { return p.status == static_cast<int>(Status::stick); };
    const auto rests = [&](const NodeState& p) {
      const double least = rounding_of_motion * std::sqrt(p.area);
      return !p.bare && p.area > 0 && (sticks(p) || (std::abs(p.gap) < least && Normal(p.slip.data()).norm() < least));
    };
    if (points.size() < 2 || std::ranges::none_of(points, sticks) || !std::ranges::all_of(points, rests)) continue;
    double area = 0;
    Point mean = Point::Zero(), direction = Point::Zero();
    for (const auto& p : points) {
      area += p.area;
      mean += p.area * Normal(p.traction.data());
      direction += p.area * Normal(p.normal.data());
    }
    mean /= area;
    direction.normalize();
    double part = 1;
    for (const auto& p : points) {
      const double off = (Normal(p.traction.data()) - mean).norm(), along = Normal(p.normal.data()).dot(direction);
      const double most = along > 0 ? mean.norm() * std::sqrt(std::max(1 - along * along, 0.0)) / along : off;
      if (off > most) part = std::min(part, most / off);
    }
    for (auto& p : points) {
      Eigen::Map<Point> traction(p.traction.data());
      traction = mean + part * (traction - mean);
      p.force = -traction.dot(Normal(p.normal.data()));
    }
  }
}

}  // namespace

std::vector<SurfaceState> surface_states(std::span<const ContactNodeState> states, std::span<const Pair> pairs,
                                         const Communicator& comm, std::span<const constraint::NodeWithoutRows> without_rows)
{
  auto own = meet(states, without_rows, comm);
  NarrowNodes narrow(own, pairs, comm);
  std::vector<double> own_area, area(pairs.size(), 0.0);
  for (const auto& node : own) own_area.push_back(node.area);
  narrow.give(own);
  narrow.take_closed(own);
  for (std::size_t i = 0; i < own.size(); ++i) area[static_cast<std::size_t>(own[i].contact)] += own[i].closed * own_area[i];
  comm.sum_in_place(area);
  for (auto& node : own) {
    if (node.bare) continue;
    node.force /= node.area;
    for (double& traction : node.traction) traction /= node.area;
  }
  limit_opposing_tractions(own);
  narrow.take_pressures(own);
  average_over_faces(own, pairs, comm);
  narrow.take_recovered(own);
  const auto all = on_sides(own, pairs, comm);
  std::vector<SurfaceState> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& nodes = pairs[c].secondary.node_id;
    SurfaceState state{std::vector<double>(nodes.size(), 0.0),
                       std::vector<double>(nodes.size(), 0.0),
                       std::vector<double>(nodes.size(), 0.0),
                       std::vector<Point>(nodes.size(), Point::Zero()),
                       std::vector<Point>(nodes.size(), Point::Zero()),
                       std::vector<int>(nodes.size(), 0),
                       std::vector<char>(nodes.size(), 0),
                       std::vector<char>(nodes.size(), 0),
                       area[c]};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto here = points_at(all, static_cast<int>(c), nodes[i]);
      if (here.empty()) continue;
      const auto node = std::max_element(here.begin(), here.end(), [](const NodeState& a, const NodeState& b) {
        return std::pair(a.force, -a.gap) < std::pair(b.force, -b.gap);
      });
      state.near[i] = 1;
      state.without_rows[i] = node->bare;
      state.pressure[i] = node->force;
      state.traction[i] = Point(node->traction[0], node->traction[1], node->traction[2]);
      state.gap[i] = node->gap;
      state.slip[i] = Point(node->slip[0], node->slip[1], node->slip[2]);
      state.status[i] = node->status;
      for (const auto& point : here) state.recovered_pressure[i] = std::max(state.recovered_pressure[i], point.recovered);
    }
    result.push_back(std::move(state));
  }
  return result;
}

}  // namespace mortise::contact
