// Points on their way between ranks, which send what can be copied byte by byte.
#pragma once

#include <array>

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

}  // namespace mortise::analysis
