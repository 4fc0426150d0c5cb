#include "state/narrow_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "integrals/overlap.hpp"
#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

// Less cover makes a strip too narrow for a pressure of its own.
constexpr double narrow = 0.35;

}  // namespace

// 0: wide enough; else in powers of what is narrow. A node gives to those of lower bands, so that one with next to no cover whose
// neighbours have little has some to give to, and what it gives passes on.
std::size_t NarrowNodes::band_of(double cover)
{
  constexpr auto most = static_cast<double>(bands);
  return cover > 0 ? static_cast<std::size_t>(std::clamp(std::floor(std::log(cover) / std::log(narrow)), 0.0, most)) : bands;
}

bool NarrowNodes::ascending(const Given& a, const Given& b)
{
  return std::tie(a.node, a.contact, a.side, a.other, a.other_side) < std::tie(b.node, b.contact, b.side, b.other, b.other_side);
}

// The narrow or the wide one's state, whichever lives here.
NodeState& NarrowNodes::state_of(std::vector<NodeState>& nodes, const Given& given)
{
  return points_at(nodes, given.contact, given.node)[static_cast<std::size_t>(given.side)];
}

// Each pair of neighbours once, on the rank of the narrow node, with the area of the wide one for a part. Collective.
std::vector<NarrowNodes::Given> NarrowNodes::neighbours(const std::vector<NodeState>& nodes, std::span<const Pair> pairs) const
{
  const auto known = on_sides(nodes, pairs, comm_);
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
          if (from && to && band_of(from->cover) > band_of(to->cover))
            found.push_back({from->node, from->contact, from->side, to->node, to->side, to->area, 0, 0, 0, {}, 0, 0});
    }
  }
  found = by_node<Given>(found, comm_);
  std::sort(found.begin(), found.end(), ascending);
  const auto same = [](const Given& a, const Given& b) { return !ascending(a, b) && !ascending(b, a); };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

NarrowNodes::NarrowNodes(const std::vector<NodeState>& nodes, std::span<const Pair> pairs, const Communicator& comm) : comm_(comm)
{
  auto found = neighbours(nodes, pairs);
  for (auto first = found.begin(); first != found.end();) {
    const auto& from = points_at(nodes, first->contact, first->node)[static_cast<std::size_t>(first->side)];
    auto end = first;
    double area = 0;  // of all neighbours
    for (; end != found.end() && std::tie(end->node, end->contact, end->side) == std::tie(from.node, from.contact, from.side);
         ++end)
      area += end->part;
    for (; first != end; ++first) {
      first->part /= area;
      given_[band_of(from.cover)].push_back(*first);
    }
  }
  for (std::size_t band = 1; band <= bands; ++band) any_[band] = comm.any(!given_[band].empty());
}

// The same on the ranks of the other nodes. Collective.
std::vector<NarrowNodes::Given> NarrowNodes::sent_across(std::vector<Given> given) const
{
  for (auto& g : given) {
    std::swap(g.node, g.other);
    std::swap(g.side, g.other_side);
  }
  given = by_node<Given>(given, comm_);
  std::sort(given.begin(), given.end(), ascending);
  return given;
}

// The narrowest first.
void NarrowNodes::give(std::vector<NodeState>& nodes)
{
  for (std::size_t band = bands; band > 0; --band) {
    if (!any_[band]) continue;
    for (auto& g : given_[band]) {
      const NodeState& from = state_of(nodes, g);
      g.area = g.part * from.area;
      g.force = g.part * from.force;
      g.closed = from.closed;
      for (std::size_t c = 0; c < 3; ++c) g.traction[c] = g.part * from.traction[c];
    }
    received_[band] = sent_across(given_[band]);
    for (const auto& g : received_[band]) {
      auto& to = state_of(nodes, g);
      to.area += g.area;
      to.force += g.force;
      to.closed = std::max(to.closed, g.closed);
      for (std::size_t c = 0; c < 3; ++c) to.traction[c] += g.traction[c];
    }
  }
}

// The narrowest last: value(given, wide), clear(narrow), add(given, narrow).
template <class Take, class Clear, class Add>
void NarrowNodes::take(std::vector<NodeState>& nodes, const Take& value, const Clear& clear, const Add& add)
{
  for (std::size_t band = 1; band <= bands; ++band) {
    if (!any_[band]) continue;
    for (auto& g : received_[band]) value(g, state_of(nodes, g));
    const auto mean = sent_across(received_[band]);
    for (const auto& g : mean) clear(state_of(nodes, g));
    for (const auto& g : mean) add(g, state_of(nodes, g));
  }
}

void NarrowNodes::take_pressures(std::vector<NodeState>& nodes)
{
  take(
      nodes,
      [](Given& g, const NodeState& wide) {
        g.force = g.part * wide.force;
        for (std::size_t c = 0; c < 3; ++c) g.traction[c] = g.part * wide.traction[c];
        g.gap = wide.gap;
        g.status = wide.status;
      },
      [](NodeState& node) {
        node.force = 0;
        node.traction = {};
      },
      [](const Given& g, NodeState& node) {
        node.force += g.force;
        for (std::size_t c = 0; c < 3; ++c) node.traction[c] += g.traction[c];
        if (!node.bare) return;
        node.gap += g.part * g.gap;
        node.status = std::max(node.status, g.status);
      });
}

void NarrowNodes::take_recovered(std::vector<NodeState>& nodes)
{
  take(
      nodes, [](Given& g, const NodeState& wide) { g.force = g.part * wide.recovered; },
      [](NodeState& node) { node.recovered = 0; }, [](const Given& g, NodeState& node) { node.recovered += g.force; });
}

void NarrowNodes::take_closed(std::vector<NodeState>& nodes)
{
  take(
      nodes, [](Given& g, const NodeState& wide) { g.force = g.part * wide.closed; },
      [](NodeState& node) { node.closed = node.status == static_cast<int>(Status::open) ? 0 : 1; },
      [](const Given& g, NodeState& node) { node.closed = std::min(node.closed + g.force, 1.0); });
}

}  // namespace mortise::contact
