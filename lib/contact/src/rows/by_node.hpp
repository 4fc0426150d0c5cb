// Entries that belong to nodes, on the ranks that need them. Those of a node meet on rank node % ranks.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"

namespace mortise::contact {

/// A point on its way, and after it.
inline std::array<double, 3> packed(const Point& p)
{
  return {p[0], p[1], p[2]};
}
inline Point unpacked(const std::array<double, 3>& a)
{
  return {a[0], a[1], a[2]};
}

/// Of all ranks' entries, which have a member `node`, those of this rank's nodes, ascending; those of one node in the order of
/// the ranks. Collective.
template <class T>
std::vector<T> by_node(std::span<const T> entries, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<T>> send(ranks);
  for (const auto& entry : entries) send[static_cast<std::size_t>(entry.node) % ranks].push_back(entry);
  std::vector<T> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  std::stable_sort(result.begin(), result.end(), [](const T& a, const T& b) { return a.node < b.node; });
  return result;
}

/// The nodes that each rank asks this one about; `nodes` are those that this rank has to do with. Collective.
inline std::vector<std::vector<Global>> ask(const std::vector<Global>& nodes, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Global>> wanted(ranks);
  for (const Global node : nodes) wanted[static_cast<std::size_t>(node) % ranks].push_back(node);
  return comm.exchange(wanted);
}

/// What other ranks have, as of by_node(), of the nodes that this one asked about, ascending; `asked` is what they asked.
/// Collective.
template <class T>
std::vector<T> answer(const std::vector<T>& entries, const std::vector<std::vector<Global>>& asked, const Communicator& comm)
{
  std::vector<std::vector<T>> send(asked.size());
  for (std::size_t r = 0; r < asked.size(); ++r)
    for (const Global node : asked[r]) {
      auto entry = std::lower_bound(entries.begin(), entries.end(), node, [](const T& e, Global n) { return e.node < n; });
      for (; entry != entries.end() && entry->node == node; ++entry) send[r].push_back(*entry);
    }
  std::vector<T> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  std::stable_sort(result.begin(), result.end(), [](const T& a, const T& b) { return a.node < b.node; });
  return result;
}

}  // namespace mortise::contact
