// Stresses at nodes of planes of symmetry. A plane with the normal n that bears no traction along itself has t . sigma n = 0 for
// all tangents t: what cells on one side recover is averaged with its mirror image, as the cells beyond the plane would have it.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "fem/stress.hpp"

namespace mortise::fem {

/// Orthonormal bases of the smallest spaces that mirror images in planes with these unit normals leave as they are, but for what
/// lies in all of the planes: of normals at right angles each alone, of others what they span together.
std::vector<std::vector<Point>> mirrored_spaces(std::span<const Point> normals);

/// The mean of `stress` and all its mirror images in planes through one point with these unit normals: every normal is a
/// principal direction of it. Of planes that are not at right angles so is all that their normals span.
Stress symmetric_stress(const Stress& stress, std::span<const Point> normals);

/// With n . sigma n = t along the unit normal n, and all the rest as it is.
Stress stress_with_traction(const Stress& stress, const Point& normal, double traction);

/// R sigma R', the stress after the body has been rotated by R.
Stress rotated_stress(const Stress& stress, const Eigen::Matrix3d& rotation);

}  // namespace mortise::fem
