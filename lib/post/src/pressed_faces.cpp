#include "pressed_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "patches.hpp"

namespace mortise::post {

namespace {

std::span<const Local> corners_of(const mesh::Surface& side, std::size_t face)
{
  return side.faces[face].first(static_cast<std::size_t>(mesh::corner_count(side.faces.type[face])));
}

bool open(const contact::SurfaceState& state, Local n)
{
  const auto i = static_cast<std::size_t>(n);
  return state.status[i] == 0 && state.near[i] && !state.without_rows[i];
}

// Those of `asked` that some rank has among `nodes`, ascending. Collective.
std::vector<SideNode> anywhere_among(std::vector<SideNode> asked, std::vector<SideNode> nodes, const Communicator& comm)
{
  std::vector<SideNode> all;
  for (const auto& part : comm.exchange(by_their_ranks(std::move(nodes), comm))) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  auto wanted = comm.exchange(by_their_ranks(std::move(asked), comm));
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

// Of each patch the largest pressures. Collective.
void set_peaks(const Patches& patches, std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
               const Communicator& comm, std::vector<PressedPatch>& result)
{
  std::vector<Found> peaks(2 * result.size());
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& side = pairs[c].secondary;
    for (std::size_t i = 0; i < surfaces[c].pressure.size(); ++i) {
      const auto patch = patches.of({static_cast<long long>(c), side.node_id[i]});
      if (!patch) continue;
      peaks[2 * *patch].take(surfaces[c].pressure[i], side.points[i]);
      peaks[2 * *patch + 1].take(surfaces[c].recovered_pressure[i], side.points[i]);
    }
  }
  peaks = largest_of_ranks(peaks, comm);
  for (std::size_t p = 0; p < result.size(); ++p) result[p].node = peaks[2 * p], result[p].recovered = peaks[2 * p + 1];
}

// A face of a contact's secondary side.
struct SideFace {
  std::size_t contact, face;
};

SideNode node_of(std::size_t contact, const mesh::Surface& side, Local n)
{
  return {static_cast<long long>(contact), side.node_id[static_cast<std::size_t>(n)]};
}

// The faces that are pressed at all corners; `at_border`, ascending: those of their corners that faces with an open corner have,
// too, on any rank. Collective.
std::vector<SideFace> whole_faces(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
                                  const Communicator& comm, std::vector<SideNode>& at_border)
{
  std::vector<SideFace> whole;
  std::vector<SideNode> corners, outer;  // of whole faces; of those with an open corner
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& side = pairs[c].secondary;
    const auto add = [&](std::vector<SideNode>& to, std::size_t f) {
      for (const Local n : corners_of(side, f)) to.push_back(node_of(c, side, n));
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
  at_border = anywhere_among(std::move(corners), std::move(outer), comm);
  return whole;
}

// Adds the whole faces of this rank, and the nodes inside, to their patches.
void count_faces(const Patches& patches, std::span<const SideFace> whole, std::span<const SideNode> at_border,
                 std::span<const contact::Pair> pairs, std::vector<PressedPatch>& result)
{
  for (const auto& [c, f] : whole) {
    const auto& side = pairs[c].secondary;
    std::optional<std::size_t> patch;
    for (const Local n : side.faces[f])
      if (!patch) patch = patches.of(node_of(c, side, n));
    if (!patch) continue;
    const auto nodes = corners_of(side, f);
    const auto inside = std::count_if(nodes.begin(), nodes.end(), [&, contact = c](Local n) {
      return !std::binary_search(at_border.begin(), at_border.end(), node_of(contact, side, n));
    });
    auto& counted = result[*patch];
    counted.whole += 1;
    counted.second_order += side.faces[f].size() > nodes.size() ? 1 : 0;
    counted.inside += static_cast<double>(inside);
    counted.core += inside == static_cast<std::ptrdiff_t>(nodes.size()) ? 1 : 0;
  }
}

// Adds the forces of this rank's contact nodes to their patches.
void add_forces(const Patches& patches, std::span<const contact::ContactNodeState> states, std::vector<PressedPatch>& result)
{
  for (const auto& p : states) {
    auto patch = patches.of({p.contact, p.node});
    for (const auto& part : p.parts)
      if (!patch) patch = patches.of({p.contact, part.node});
    if (!patch) continue;
    result[*patch].force += std::abs(p.force);
    if (!p.parts.empty()) result[*patch].between += std::abs(p.force);
  }
}

// Of all ranks. Collective.
void sum_over_ranks(std::vector<PressedPatch>& patches, const Communicator& comm)
{
  constexpr std::array summed{&PressedPatch::whole, &PressedPatch::second_order, &PressedPatch::inside,
                              &PressedPatch::core,  &PressedPatch::force,        &PressedPatch::between};
  std::vector<double> sums;
  for (const auto& patch : patches)
    for (const auto member : summed) sums.push_back(patch.*member);
  comm.sum_in_place(sums);
  auto sum = sums.begin();
  for (auto& patch : patches)
    for (const auto member : summed) patch.*member = *sum++;
}

}  // namespace

std::vector<PressedPatch> pressed_patches(std::span<const contact::SurfaceState> surfaces,
                                          std::span<const contact::ContactNodeState> states, std::span<const contact::Pair> pairs,
                                          const Communicator& comm)
{
  std::vector<SideNode> of_points;
  for (const auto& p : states) {
    of_points.push_back({p.contact, p.node});
    for (const auto& part : p.parts) of_points.push_back({p.contact, part.node});
  }
  const Patches patches(surfaces, pairs, std::move(of_points), comm);
  std::vector<SideNode> at_border;
  const auto whole = whole_faces(surfaces, pairs, comm, at_border);
  std::vector<PressedPatch> result;
  for (const int contact : patches.contacts()) result.emplace_back().contact = contact;
  count_faces(patches, whole, at_border, pairs, result);
  add_forces(patches, states, result);
  sum_over_ranks(result, comm);
  set_peaks(patches, surfaces, pairs, comm, result);
  return result;
}

}  // namespace mortise::post
