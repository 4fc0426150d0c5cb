// Points on their way between ranks, which send what can be copied byte by byte; and where what is known of a node meets.
#pragma once

#include <array>

#include "base/communicator.hpp"
#include "base/types.hpp"

namespace mortise::analysis {

inline Point point(const std::array<double, 3>& x)
{
  return {x[0], x[1], x[2]};
}

inline std::array<double, 3> components(const Point& x)
{
  return {x[0], x[1], x[2]};
}

/// The rank node % ranks.
inline std::size_t home(Global node, const Communicator& comm)
{
  return static_cast<std::size_t>(node % comm.size());
}

}  // namespace mortise::analysis
