#include "pressed_faces.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <numeric>
#include <optional>

namespace mortise::post {

namespace {

// A node of a contact's secondary side.
struct SideNode {
  Global node;
  long long contact;
  auto operator<=>(const SideNode&) const = default;
};

std::span<const Local> corners_of(const mesh::Surface& side, std::size_t face)
{
  return side.faces[face].first(static_cast<std::size_t>(mesh::corner_count(side.faces.type[face])));
}

bool open(const contact::SurfaceState& state, Local n)
{
  const auto i = static_cast<std::size_t>(n);
  return state.status[i] == 0 && state.near[i] && !state.without_rows[i];
}

std::vector<std::vector<SideNode>> to_their_ranks(std::vector<SideNode> nodes, const Communicator& comm)
{
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<SideNode>> send(ranks);
  for (const auto& n : nodes) send[static_cast<std::size_t>(n.node) % ranks].push_back(n);
  return comm.exchange(send);
}

// Those of `asked` that some rank has among `nodes`, ascending. Collective.
std::vector<SideNode> anywhere_among(std::vector<SideNode> asked, std::vector<SideNode> nodes, const Communicator& comm)
{
  std::vector<SideNode> all;
  for (const auto& part : to_their_ranks(std::move(nodes), comm)) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  auto wanted = to_their_ranks(std::move(asked), comm);
  for (auto& part : wanted)
    std::erase_if(part, [&](const SideNode& n) { return !std::binary_search(all.begin(), all.end(), n); });
  std::vector<SideNode> result;
  for (const auto& part : comm.exchange(wanted)) result.insert(result.end(), part.begin(), part.end());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

std::pair<std::ptrdiff_t, std::ptrdiff_t> pressed_corners(const mesh::Surface& side, const contact::SurfaceState& state,
                                                          std::size_t face)
{
  const auto nodes = side.faces[face];
  const auto corners = corners_of(side, face);
  const auto bare = [&](Local n) { return !state.without_rows.empty() && state.without_rows[static_cast<std::size_t>(n)]; };
  const auto pressed = [&](Local n) { return state.status[static_cast<std::size_t>(n)] != 0; };
  const bool all = std::all_of(nodes.begin(), nodes.end(), [&](Local n) { return bare(n) || pressed(n); });
  const auto count = std::count_if(corners.begin(), corners.end(), [&](Local n) { return pressed(n) && (all || !bare(n)); });
  return {count, static_cast<std::ptrdiff_t>(corners.size())};
}

namespace {

// The patches that faces with pressed nodes make up, where they have nodes in common: one that is open among pressed ones, as
// beside the corner of a punch, parts nothing. The same on every rank.
class Patches {
 public:
  // Collective.
  Patches(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs, const Communicator& comm)
  {
    struct Link {
      SideNode one, other;
    };
    std::vector<Link> links;
    for (std::size_t c = 0; c < pairs.size(); ++c) {
      if (pairs[c].options.law == contact::Law::bonded) continue;
      const auto& side = pairs[c].secondary;
      for (std::size_t f = 0; f < side.faces.size(); ++f) {
        const auto nodes = side.faces[f];
        if (std::ranges::none_of(nodes, [&](Local n) { return surfaces[c].status[static_cast<std::size_t>(n)] != 0; })) continue;
        const auto node = [&](Local n) { return SideNode{side.node_id[static_cast<std::size_t>(n)], static_cast<long long>(c)}; };
        for (const Local n : nodes) links.push_back({node(nodes.front()), node(n)});
      }
    }
    links = comm.all_gather(links);
    for (const auto& link : links) nodes_.push_back(link.one), nodes_.push_back(link.other);
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    std::vector<std::size_t> root(nodes_.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (const auto& link : links) {
      const auto a = find(*place(link.one)), b = find(*place(link.other));
      root[std::max(a, b)] = std::min(a, b);
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (find(i) == i) {
        patch_.push_back(contact_.size());
        contact_.push_back(static_cast<int>(nodes_[i].contact));
      } else {
        patch_.push_back(patch_[find(i)]);
      }
    }
    // By contact.
    std::vector<std::size_t> order(contact_.size()), rank(contact_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return contact_[a] < contact_[b]; });
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    for (auto& patch : patch_) patch = rank[patch];
    std::sort(contact_.begin(), contact_.end());
  }

  const std::vector<int>& contacts() const { return contact_; }  // of each patch
  // None of a node far from those that are pressed.
  std::optional<std::size_t> of(Global node, int contact) const
  {
    const auto at = place({node, contact});
    return at ? std::optional(patch_[*at]) : std::nullopt;
  }

 private:
  std::optional<std::size_t> place(const SideNode& node) const
  {
    const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node);
    if (at == nodes_.end() || *at != node) return {};
    return static_cast<std::size_t>(at - nodes_.begin());
  }

  std::vector<SideNode> nodes_;
  std::vector<std::size_t> patch_;
  std::vector<int> contact_;
};

// Of each patch the largest pressures. Collective.
void set_peaks(const Patches& patches, std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
               const Communicator& comm, std::vector<PressedPatch>& result)
{
  std::vector<Found> peaks(2 * result.size());
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& side = pairs[c].secondary;
    for (std::size_t i = 0; i < surfaces[c].pressure.size(); ++i) {
      const auto patch = patches.of(side.node_id[i], static_cast<int>(c));
      if (!patch) continue;
      peaks[2 * *patch].take(surfaces[c].pressure[i], side.points[i]);
      peaks[2 * *patch + 1].take(surfaces[c].recovered_pressure[i], side.points[i]);
    }
  }
  peaks = largest_of_ranks(peaks, comm);
  for (std::size_t p = 0; p < result.size(); ++p) result[p].node = peaks[2 * p], result[p].recovered = peaks[2 * p + 1];
}

}  // namespace

std::vector<PressedPatch> pressed_patches(std::span<const contact::SurfaceState> surfaces,
                                          std::span<const contact::ContactNodeState> points, std::span<const contact::Pair> pairs,
                                          const Communicator& comm)
{
  struct Face {
    std::size_t contact, face;
  };
  const Patches patches(surfaces, pairs, comm);
  std::vector<Face> whole;
  std::vector<SideNode> corners, outer;  // of whole faces; of those with an open corner
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& side = pairs[c].secondary;
    const auto add = [&](std::vector<SideNode>& to, std::size_t f) {
      for (const Local n : corners_of(side, f))
        to.push_back({side.node_id[static_cast<std::size_t>(n)], static_cast<long long>(c)});
    };
    for (std::size_t f = 0; f < side.faces.size(); ++f) {
      const auto nodes = corners_of(side, f);
      if (const auto [count, all] = pressed_corners(side, surfaces[c], f); count == all) {
        whole.push_back({c, f});
        add(corners, f);
      } else if (std::any_of(nodes.begin(), nodes.end(), [&](Local n) { return open(surfaces[c], n); })) {
        add(outer, f);
      }
    }
  }
  const auto at_border = anywhere_among(std::move(corners), std::move(outer), comm);
  constexpr std::size_t kinds = 6;
  std::vector<double> sums(kinds * patches.contacts().size(), 0.0);
  for (const auto& [c, f] : whole) {
    const auto& side = pairs[c].secondary;
    std::optional<std::size_t> patch;
    for (const Local n : side.faces[f])
      if (!patch) patch = patches.of(side.node_id[static_cast<std::size_t>(n)], static_cast<int>(c));
    if (!patch) continue;
    const auto nodes = corners_of(side, f);
    const auto inside = std::count_if(nodes.begin(), nodes.end(), [&](Local n) {
      const SideNode node{side.node_id[static_cast<std::size_t>(n)], static_cast<long long>(c)};
      return !std::binary_search(at_border.begin(), at_border.end(), node);
    });
    double* sum = &sums[kinds * *patch];
    sum[0] += 1;
    sum[1] += side.faces[f].size() > nodes.size() ? 1 : 0;
    sum[2] += static_cast<double>(inside);
    sum[3] += inside == static_cast<std::ptrdiff_t>(nodes.size()) ? 1 : 0;
  }
  for (const auto& p : points) {
    auto patch = patches.of(p.node, p.contact);
    for (const auto& part : p.parts)
      if (!patch) patch = patches.of(part.node, p.contact);
    if (!patch) continue;
    sums[kinds * *patch + 4] += std::abs(p.force);
    if (!p.parts.empty()) sums[kinds * *patch + 5] += std::abs(p.force);
  }
  comm.sum_in_place(sums);
  std::vector<PressedPatch> result;
  for (const int contact : patches.contacts()) {
    const double* sum = &sums[kinds * result.size()];
    result.push_back({contact, sum[0], sum[1], sum[2], sum[3], sum[4], sum[5], {}, {}});
  }
  set_peaks(patches, surfaces, pairs, comm, result);
  return result;
}

}  // namespace mortise::post
