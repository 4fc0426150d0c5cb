#include "partition/node_homes.hpp"

#include <algorithm>

namespace mortise::partition {

NodeHomes::NodeHomes(const Decomposition& decomposition, const Interface& interface, const NodeDirectory& directory,
                     std::span<const Global> others, const Communicator& comm)
    : here_(static_cast<std::size_t>(comm.rank()))
{
  const auto first_rank = [&](std::span<const Copy> copies) { return decomposition.rank_of(copies.front().subdomain); };
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto id = [&](Local n) { return subdomain.mesh.node_id[static_cast<std::size_t>(n)]; };
    for (const Local n : directory.surface(s)) known_.emplace(id(n), Known{comm.rank(), {}, subdomain.id, n});
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      const auto copies = interface.copies[s][i];
      known_[id(interface.nodes[s][i])] = {first_rank(copies), copies};
    }
  }
  std::vector<Global> asked;
  for (const Global node : others)
    if (!known_.contains(node)) asked.push_back(node);
  std::ranges::sort(asked);
  asked.erase(std::ranges::unique(asked).begin(), asked.end());
  const auto found = directory.find(asked, comm);
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (!found[i].empty()) known_.emplace(asked[i], Known{first_rank(found[i])});
}

std::size_t NodeHomes::operator()(Global node) const
{
  const auto found = known_.find(node);
  return found == known_.end() ? here_ : static_cast<std::size_t>(found->second.rank);
}

std::vector<Copy> NodeHomes::copies(Global node) const
{
  const auto found = known_.find(node);
  if (found == known_.end()) return {};
  const auto& known = found->second;
  if (!known.shared.empty()) return {known.shared.begin(), known.shared.end()};
  if (known.subdomain < 0) return {};
  return {{known.subdomain, known.node, 0}};
}

}  // namespace mortise::partition
