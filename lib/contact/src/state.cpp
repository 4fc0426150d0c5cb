#include "contact/state.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "overlap.hpp"

namespace mortise::contact {

PointState state_of(const constraint::ContactPoint& point, bool bonded, std::span<const double> multipliers,
                    std::span<const double> jumps, double bound, double limit, double nothing)
{
  PointState state;
  state.contact = point.contact;
  state.node = point.node;
  state.area = point.area;
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
  std::vector<double> sums(contacts * width, 0.0), pressure(contacts, 0.0);
  for (const auto& p : points) {
    double* s = &sums[static_cast<std::size_t>(p.contact) * width];
    for (int c = 0; c < 3; ++c) s[c] += p.force_on_secondary[c];
    if (p.status != Status::open) s[3] += p.area;
    s[4 + static_cast<int>(p.status)] += 1;
    auto& largest = pressure[static_cast<std::size_t>(p.contact)];
    largest = std::max(largest, p.force / p.area);
  }
  comm.sum_in_place(sums);
  std::vector<Resultant> result(contacts);
  for (std::size_t c = 0; c < contacts; ++c) {
    const double* s = &sums[c * width];
    result[c] = {Point(s[0], s[1], s[2]), comm.max(pressure[c]), s[3],
                 std::llround(s[4]),      std::llround(s[5]),    std::llround(s[6])};
  }
  return result;
}

namespace {

// A PointState as plain bytes.
struct Sent {
  int contact, status;
  Global node;
  double area, force, gap;
  double traction[3], slip[3];
};

std::vector<Sent> gather(std::span<const PointState> points, const Communicator& comm)
{
  std::vector<Sent> mine;
  for (const auto& p : points)
    mine.push_back({p.contact,
                    static_cast<int>(p.status),
                    p.node,
                    p.area,
                    p.force,
                    p.gap,
                    {p.force_on_secondary[0], p.force_on_secondary[1], p.force_on_secondary[2]},
                    {p.slip[0], p.slip[1], p.slip[2]}});
  return comm.all_gather(mine);
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
  const auto all = gather(points, comm);
  std::map<std::pair<int, Global>, std::vector<const Sent*>> at;
  for (const auto& p : all) at[{p.contact, p.node}].push_back(&p);
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
      const auto found = at.find({static_cast<int>(c), nodes[i]});
      if (found == at.end()) continue;
      double area = 0;
      for (const auto* p : found->second) area += p->area;
      for (const auto* p : found->second) {
        state.pressure[i] += p->force / area;
        state.traction[i] += Point(p->traction[0], p->traction[1], p->traction[2]) / area;
        state.gap[i] += p->gap * p->area / area;
        state.slip[i] += Point(p->slip[0], p->slip[1], p->slip[2]) * p->area / area;
        state.status[i] = std::max(state.status[i], p->status);
      }
    }
    state.recovered_pressure = averaged_over_faces(pairs[c].secondary, state.pressure, comm);
    result.push_back(std::move(state));
  }
  return result;
}

}  // namespace mortise::contact
