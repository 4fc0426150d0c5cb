// What a result is at a point, told by one number, under the names that decks and tables give it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem/stress.hpp"

namespace mortise::fem {

enum class Quantity {
  von_mises,
  principal_stress,  ///< the largest of the three, or the smallest
  displacement,      ///< its length
  pressure,          ///< of contacts
  ux,
  uy,
  uz,
  sxx,
  syy,
  szz,
  sxy,
  syz,
  sxz
};

/// In the order of the above.
const std::vector<std::string>& quantity_names();
/// Nothing if there is none of that name.
std::optional<Quantity> quantity(const std::string& name);

/// The eigenvalues of the stress tensor, the largest first.
Eigen::Vector3d principal_stresses(const Stress& stress);

/// The stress along other axes: unit vectors, in rows.
Stress along(const Eigen::Matrix3d& axes, const Stress& stress);

/// Of displacement and stress at a point; of principal stresses the largest or the smallest. Not for pressures.
double value(Quantity quantity, bool smallest, const Point& displacement, const Stress& stress);

}  // namespace mortise::fem
