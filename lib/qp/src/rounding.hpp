// What rounding leaves of residuals.
#pragma once

#include <algorithm>

namespace mortise::qp {

// What rounding leaves of the difference of two vectors, over their size and over the tolerance of what it is compared with.
inline double rounding_over(double tolerance)
{
  constexpr double rounding = 1e-13;      // no residual below this part of what it is a difference of means anything
  constexpr double finest_asked = 1e-10;  // finer tolerances are taken at their word
  return rounding / std::max(tolerance, finest_asked);
}

}  // namespace mortise::qp
