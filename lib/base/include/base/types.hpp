// The types that every module agrees on. They are those for which Debian's Trilinos is instantiated.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mortise {

using Scalar = double;
using Local = int;         ///< index on one rank (nodes, rows, entries of one subdomain)
using Global = long long;  ///< index over all ranks

using Point = Eigen::Vector3d;  ///< coordinates or a vector in space; 2D models leave the third component at zero

}  // namespace mortise
