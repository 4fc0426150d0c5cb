#include "patches.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace mortise::post {

namespace {

// Two that are in one patch.
struct Link {
  SideNode one, other;
  auto operator<=>(const Link&) const = default;
};

template <class T>
void each_once(std::vector<T>& values)
{
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

template <class T>
std::optional<std::size_t> place(const std::vector<T>& sorted, const T& value)
{
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
  if (at == sorted.end() || *at != value) return {};
  return static_cast<std::size_t>(at - sorted.begin());
}

// For each of these nodes, ascending, the first one of those that links join it to.
std::vector<std::size_t> join(const std::vector<SideNode>& nodes, const std::vector<Link>& links)
{
  std::vector<std::size_t> root(nodes.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& link : links) {
    const auto a = find(*place(nodes, link.one)), b = find(*place(nodes, link.other));
    root[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) root[i] = find(i);
  return root;
}

// Of this rank's faces with pressed nodes: each node with the first one.
std::vector<Link> links_of(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs)
{
  std::vector<Link> links;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (pairs[c].options.law == contact::Law::bonded) continue;
    const auto& side = pairs[c].secondary;
    for (std::size_t f = 0; f < side.faces.size(); ++f) {
      const auto nodes = side.faces[f];
      if (std::ranges::none_of(nodes, [&](Local n) { return surfaces[c].status[static_cast<std::size_t>(n)] != 0; })) continue;
      const auto node = [&](Local n) { return SideNode{static_cast<long long>(c), side.node_id[static_cast<std::size_t>(n)]}; };
      for (const Local n : nodes) links.push_back({node(nodes.front()), node(n)});
    }
  }
  return links;
}

std::size_t rank_of(const SideNode& node, const Communicator& comm)
{
  return static_cast<std::size_t>(node.node) % static_cast<std::size_t>(comm.size());
}

}  // namespace

std::vector<std::vector<SideNode>> by_their_ranks(std::vector<SideNode> nodes, const Communicator& comm)
{
  each_once(nodes);
  std::vector<std::vector<SideNode>> result(static_cast<std::size_t>(comm.size()));
  for (const auto& n : nodes) result[rank_of(n, comm)].push_back(n);
  return result;
}

Patches::Patches(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
                 std::vector<SideNode> asked, const Communicator& comm)
{
  // Parts: what this rank's faces join, each named by its first node.
  const auto links = links_of(surfaces, pairs);
  for (const auto& link : links) nodes_.push_back(link.one), nodes_.push_back(link.other);
  each_once(nodes_);
  const auto first = join(nodes_, links);
  std::vector<SideNode> parts;
  std::vector<std::vector<Link>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (first[i] == i) parts.push_back(nodes_[i]);
    send[rank_of(nodes_[i], comm)].push_back({nodes_[i], nodes_[first[i]]});
  }

  // The rank that looks after a node knows which parts have it.
  std::vector<Link> part_of;
  for (const auto& from : comm.exchange(send)) part_of.insert(part_of.end(), from.begin(), from.end());
  each_once(part_of);
  std::vector<Link> meet;
  for (std::size_t i = 1; i < part_of.size(); ++i)
    if (part_of[i].one == part_of[i - 1].one) meet.push_back({part_of[i - 1].other, part_of[i].other});
  each_once(meet);
  parts = comm.all_gather(parts);
  each_once(parts);
  const auto patch_begins = join(parts, comm.all_gather(meet));
  std::vector<std::size_t> number(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    number[i] = patch_begins[i] == i ? contact_.size() : number[patch_begins[i]];
    if (patch_begins[i] == i) contact_.push_back(static_cast<int>(parts[i].contact));
  }
  for (const auto i : first) patch_.push_back(number[*place(parts, nodes_[i])]);

  // And tells those who ask.
  const auto elsewhere = by_their_ranks(std::move(asked), comm);
  auto wanted = comm.exchange(elsewhere);
  std::vector<std::vector<Link>> answer(wanted.size());
  for (std::size_t r = 0; r < wanted.size(); ++r)
    for (const auto& n : wanted[r]) {
      const auto at =
          std::lower_bound(part_of.begin(), part_of.end(), n, [](const Link& l, const SideNode& s) { return l.one < s; });
      if (at != part_of.end() && at->one == n) answer[r].push_back(*at);
    }
  std::vector<std::pair<SideNode, std::size_t>> all;
  for (std::size_t i = 0; i < nodes_.size(); ++i) all.emplace_back(nodes_[i], patch_[i]);
  for (const auto& from : comm.exchange(answer))
    for (const auto& [node, part] : from) all.emplace_back(node, number[*place(parts, part)]);
  each_once(all);
  nodes_.clear(), patch_.clear();
  for (const auto& [node, patch] : all) nodes_.push_back(node), patch_.push_back(patch);
}

std::optional<std::size_t> Patches::of(const SideNode& node) const
{
  const auto at = place(nodes_, node);
  return at ? std::optional(patch_[*at]) : std::nullopt;
}

}  // namespace mortise::post
