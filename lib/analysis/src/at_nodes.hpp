// What faces tell the homes of their nodes.
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "base/communicator.hpp"

namespace mortise::analysis {

/// What was sent to this rank, T with a node and a face, ascending by both. Collective.
template <class T>
std::vector<T> by_node_and_face(const std::vector<std::vector<T>>& send, const Communicator& comm)
{
  std::vector<T> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  std::sort(result.begin(), result.end(),
            [](const T& a, const T& b) { return std::tie(a.node, a.face) < std::tie(b.node, b.face); });
  return result;
}

}  // namespace mortise::analysis
