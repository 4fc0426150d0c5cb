// Subdomains that are copies of each other, found by comparison: they can share a stiffness matrix and its factorization.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// What a subdomain is a copy of: points of the copy = rotation * points of the original + a translation.
struct CopyOf {
  std::size_t original;                     ///< index of this rank's subdomain; its own if it is a copy of none before it
  std::optional<Eigen::Matrix3d> rotation;  ///< none for a translation alone
};

/// What may tell a copy from its original: a rotation and a translation, or, where the y axis is an axis of revolution, a
/// translation along it.
enum class Motions { rigid, along_y };

/// For each subdomain of this rank the first one of this rank with the same cells (in the same local numbering), the same points
/// up to one of the `motions`, to 1e-10 of its size, and the same `kind` (one number per subdomain for whatever else must agree,
/// such as the material). `alike`, if given: whether what has directions agrees as well, for an original, a copy and its
/// rotation.
using Alike = std::function<bool(const Subdomain& original, const Subdomain& copy, const Eigen::Matrix3d& rotation)>;
std::vector<CopyOf> congruent(const std::vector<Subdomain>& subdomains, const std::vector<int>& kind,
                              Motions motions = Motions::rigid, const Alike& alike = {});

}  // namespace mortise::partition
