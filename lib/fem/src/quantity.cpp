#include "fem/quantity.hpp"

#include <algorithm>

#include "base/dense.hpp"
#include "tensor.hpp"

namespace mortise::fem {

const std::vector<std::string>& quantity_names()
{
  static const std::vector<std::string> names{
      "von_mises", "principal_stress", "displacement", "pressure", "ux", "uy", "uz", "sxx", "syy", "szz", "sxy", "syz", "sxz"};
  return names;
}

std::optional<Quantity> quantity(const std::string& name)
{
  const auto& names = quantity_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  return static_cast<Quantity>(found - names.begin());
}

Eigen::Vector3d principal_stresses(const Stress& s)
{
  return dense::space_eigenvalues(tensor(s)).reverse();
}

Stress along(const Eigen::Matrix3d& axes, const Stress& stress)
{
  return entries(axes * tensor(stress) * axes.transpose());
}

double value(Quantity quantity, bool smallest, const Point& displacement, const Stress& stress)
{
  if (quantity == Quantity::von_mises) return von_mises(stress);
  if (quantity == Quantity::principal_stress) return principal_stresses(stress)[smallest ? 2 : 0];
  if (quantity == Quantity::displacement) return displacement.norm();
  if (quantity < Quantity::sxx) return displacement[static_cast<int>(quantity) - static_cast<int>(Quantity::ux)];
  return stress[static_cast<int>(quantity) - static_cast<int>(Quantity::sxx)];
}

}  // namespace mortise::fem
