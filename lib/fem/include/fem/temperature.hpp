// How much warmer a piece is than when it had no stress.
#pragma once

#include <functional>

#include "mesh/mesh.hpp"

namespace mortise::fem {

/// A change of temperature in degrees: the sum of a number and of what varies in space.
struct Temperature {
  Temperature(double degrees = 0) : uniform(degrees) {}  // NOLINT: a number is a temperature

  double uniform;
  std::function<double(const Point&)> varying = {};  ///< none, or finite everywhere

  bool any() const { return uniform != 0 || varying; }
};

}  // namespace mortise::fem
