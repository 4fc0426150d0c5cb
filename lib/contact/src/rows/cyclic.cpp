#include "contact/cyclic.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mortise::contact {

std::optional<mesh::Motion> rotation_of(const Options& options)
{
  if (!options.cyclic) return {};
  mesh::InstanceOptions once;
  once.rotate = options.cyclic;
  return mesh::motions({once}).front();
}

mesh::Surface rotated(mesh::Surface surface, const Options& options)
{
  if (const auto rotation = rotation_of(options))
    for (auto& x : surface.points) x = (*rotation)(x);
  return surface;
}

std::string misfit(const mesh::RotationOptions& cyclic, fem::Kinematics kinematics)
{
  if (kinematics == fem::Kinematics::axisymmetric) return "an axisymmetric model is the whole turn; it has no sectors";
  if (kinematics != fem::Kinematics::solid && (cyclic.axis[0] != 0 || cyclic.axis[1] != 0))
    return "a plane model turns about z; expected axis: [0, 0, 1]";
  const double angle = std::abs(cyclic.angle), sectors = angle > 0 ? std::round(360 / angle) : 0;
  if (sectors >= 2 && std::abs(sectors * angle - 360) <= 1e-6) return "";
  const auto nearest = static_cast<long long>(std::min(std::max(sectors, 2.0), 1e6));
  return fmt::format("{:.10g} degrees are no n-th part of the full turn; expected 360/n with n >= 2, such as 360/{} = {:.10g}",
                     cyclic.angle, nearest, 360.0 / static_cast<double>(nearest));
}

}  // namespace mortise::contact
