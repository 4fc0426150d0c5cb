// Angles between directions.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "base/types.hpp"

namespace mortise::contact {

/// Between two vectors of any length but zero, 0 to pi.
inline double angle_between(const Point& a, const Point& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace mortise::contact
