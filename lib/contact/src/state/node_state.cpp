#include "state/node_state.hpp"

#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

// A face belongs to the points at its nodes whose normals enclose less than some 40 degrees with its own: beyond a kink are
// others.
constexpr double one_side = 0.75;

bool before(const NodeState& a, const NodeState& b)
{
  return std::tie(a.node, a.contact) < std::tie(b.node, b.contact);
}

auto key(const NodeState& state)
{
  return std::tie(state.node, state.contact, state.side);
}

void join(NodeState& to, const NodeState& other)
{
  if (other.bare) return;
  if (to.bare) {
    const auto normal = to.normal;
    to = other;
    to.normal = normal;
    return;
  }
  if (other.area == 0)
    to.closed = std::max(to.closed, other.closed);
  else
    to.closed = (to.area * to.closed + other.area * other.closed) / (to.area + other.area);
  to.area += other.area;
  to.force += other.force;
  for (std::size_t c = 0; c < 3; ++c) to.traction[c] += other.traction[c];
  if (to.status == static_cast<int>(Status::open)) to.status = other.status;
}

// A corner of the primary side, or a place between nodes, has a row, but no place in the output: what presses there counts with
// the node beside it, or with the nodes round it, on the same side of a kink. Nor have several rows that a node is the image of:
// they are one. `nodes` are sorted.
void join_rows(std::vector<NodeState>& nodes)
{
  constexpr double one_normal = 0.9, same_normal = 0.99;  // cosines
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
        const double least = corners ? one_normal : same_normal;
        const auto to = std::find_if(joined.begin() + static_cast<std::ptrdiff_t>(begin), joined.end(),
                                     [&](const NodeState& other) { return dot(other, nodes[i]) > least; });
        if (to == joined.end())
          joined.push_back(nodes[i]);
        else
          join(*to, nodes[i]);
      }
  }
  nodes = std::move(joined);
}

// What a place between nodes gives one of them. Those that bear next to nothing of it are not closed for it.
NodeState part_of(const NodeState& place, const constraint::Part& part)
{
  NodeState result = place;
  result.node = part.node;
  result.normal = {part.normal[0], part.normal[1], part.normal[2]};
  result.area = result.cover = 0;
  result.force *= part.part;
  for (double& traction : result.traction) traction *= part.part;
  if (part.part < bears) result.status = static_cast<int>(Status::open), result.closed = 0;
  return result;
}

}  // namespace

std::vector<NodeState> meet(std::span<const ContactNodeState> states, std::span<const constraint::NodeWithoutRows> without_rows,
                            const Communicator& comm)
{
  std::vector<NodeState> mine;
  for (const auto& p : states) {
    const auto &n = p.normal, &f = p.force_on_secondary, &s = p.slip;
    const NodeState state{p.node,
                          p.contact,
                          0,
                          static_cast<int>(p.status),
                          p.area,
                          p.cover,
                          p.force,
                          p.gap,
                          {n[0], n[1], n[2]},
                          {f[0], f[1], f[2]},
                          {s[0], s[1], s[2]},
                          0,
                          p.status == Status::open ? 0.0 : 1.0};
    if (p.parts.empty()) mine.push_back(state);
    for (const auto& part : p.parts) mine.push_back(part_of(state, part));
  }
  for (const auto& p : without_rows) {
    NodeState state{};
    state.node = p.node;
    state.contact = p.contact;
    state.normal = p.normal;
    state.bare = true;
    mine.push_back(state);
  }
  auto nodes = by_node<NodeState>(mine, comm);
  std::stable_sort(nodes.begin(), nodes.end(), [](const NodeState& a, const NodeState& b) {
    return std::tie(a.node, a.contact, a.normal) < std::tie(b.node, b.contact, b.normal);
  });
  join_rows(nodes);
  for (std::size_t i = 1; i < nodes.size(); ++i)
    if (!before(nodes[i - 1], nodes[i])) nodes[i].side = nodes[i - 1].side + 1;
  return nodes;
}

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

}  // namespace mortise::contact
