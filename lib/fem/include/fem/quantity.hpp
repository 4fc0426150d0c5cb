// Results at a point as single numbers, under the names that decks and tables give them.
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

/// The names of all quantities, in the order of the above.
const std::vector<std::string>& quantity_names();
/// The quantity of that name; nothing if there is none.
std::optional<Quantity> quantity(const std::string& name);

/// The eigenvalues of the stress tensor, the largest first.
Eigen::Vector3d principal_stresses(const Stress& stress);

/// The components of a stress along other axes, unit vectors in the rows of `axes`.
Stress along(const Eigen::Matrix3d& axes, const Stress& stress);

/// The value of a quantity for this displacement and this stress; of principal stresses the largest or, if `smallest`, the
/// smallest. Not for pressures.
double value(Quantity quantity, bool smallest, const Point& displacement, const Stress& stress);

}  // namespace mortise::fem
