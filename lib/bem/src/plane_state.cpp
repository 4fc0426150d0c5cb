#include "bem/plane_state.hpp"

namespace mortise::bem {

fem::Material in_plane(const fem::Material& material, fem::Kinematics kinematics)
{
  const double nu = material.poisson_ratio;
  auto result = material;
  if (kinematics == fem::Kinematics::plane_strain) result.thermal_expansion *= 1 + nu;
  if (kinematics == fem::Kinematics::plane_stress) {
    result.poisson_ratio = nu / (1 + nu);
    result.young_modulus *= (1 + 2 * nu) / ((1 + nu) * (1 + nu));
  }
  return result;
}

double stress_across_plane(const fem::Constitution& constitution, fem::Kinematics kinematics, double sum)
{
  if (kinematics != fem::Kinematics::plane_strain) return 0;
  const auto& material = constitution.materials[0];
  return material.poisson_ratio * sum -
         material.young_modulus * material.thermal_expansion * constitution.temperature_change.uniform;
}

}  // namespace mortise::bem
