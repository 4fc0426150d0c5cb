// Stresses as matrices.
#pragma once

#include "fem/stress.hpp"

namespace mortise::fem {

using Tensor = Eigen::Matrix3d;

inline Tensor tensor(const Stress& s)
{
  return (Tensor() << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]).finished();
}

inline Stress entries(const Tensor& t)
{
  return (Stress() << t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(1, 2), t(0, 2)).finished();
}

}  // namespace mortise::fem
