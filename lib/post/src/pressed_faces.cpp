#include "pressed_faces.hpp"

#include <algorithm>
#include <compare>

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

std::vector<PressedFaces> pressed_faces(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
                                        const Communicator& comm)
{
  struct Face {
    std::size_t contact, face;
  };
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
  std::vector<double> sums(4 * pairs.size(), 0.0);
  for (const auto& [c, f] : whole) {
    const auto& side = pairs[c].secondary;
    const auto nodes = corners_of(side, f);
    const auto inside = std::count_if(nodes.begin(), nodes.end(), [&](Local n) {
      const SideNode node{side.node_id[static_cast<std::size_t>(n)], static_cast<long long>(c)};
      return !std::binary_search(at_border.begin(), at_border.end(), node);
    });
    double* sum = &sums[4 * c];
    sum[0] += 1;
    sum[1] += side.faces[f].size() > nodes.size() ? 1 : 0;
    sum[2] += static_cast<double>(inside);
    sum[3] += inside == static_cast<std::ptrdiff_t>(nodes.size()) ? 1 : 0;
  }
  comm.sum_in_place(sums);
  std::vector<PressedFaces> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const double* sum = &sums[4 * c];
    result.push_back({sum[0], sum[1], sum[2], sum[3]});
  }
  return result;
}

}  // namespace mortise::post
