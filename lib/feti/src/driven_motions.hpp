// What is said of free rigid motions, and of those that loads drive.
#pragma once

#include <string>
#include <vector>

#include "feti/drives.hpp"

namespace mortise::feti {

/// drive_limits(), from the `opposed_loads` of all bodies, or none.
DriveLimits limits_of(const FreeMotion& motion, const std::vector<double>& opposed_loads);

/// `body "ring" moves along (0, 1, 0), and 2 other bodies with it`; `sizes`: of the bodies.
std::string describe(const FreeMotion& motion, const std::vector<mesh::Body>& bodies, const std::vector<double>& sizes);

/// The same as a line of throw_driven().
std::string driven_by_loads(const FreeMotion& motion, const std::vector<mesh::Body>& bodies, const std::vector<double>& sizes);

/// Throws Error(no_equilibrium) that tells of these motions.
[[noreturn]] void throw_driven(const std::string& motions);

}  // namespace mortise::feti
