#include "driven_motions.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace mortise::feti {

DriveLimits limits_of(const FreeMotion& motion, const std::vector<double>& opposed_loads)
{
  double opposed = 0;
  for (const auto& part : motion.motions)
    if (!opposed_loads.empty()) opposed += opposed_loads[static_cast<std::size_t>(part.body)];
  return drive_limits(motion, motion.force > 0 ? opposed / motion.force : 0);
}

std::string describe(const FreeMotion& motion, const std::vector<mesh::Body>& bodies, const std::vector<double>& sizes)
{
  const auto& first = motion.motions.front();
  std::string text = fmt::format("body \"{}\" {}", bodies[static_cast<std::size_t>(first.body)].name,
                                 describe(first, sizes[static_cast<std::size_t>(first.body)]));
  if (motion.motions.size() > 1) text += fmt::format(", and {} other bodies with it", motion.motions.size() - 1);
  return text;
}

std::string driven_by_loads(const FreeMotion& motion, const std::vector<mesh::Body>& bodies, const std::vector<double>& sizes)
{
  constexpr double small = 1e-2;
  return fmt::format("\n  {}, driven by its loads{}", describe(motion, bodies, sizes),
                     motion.work < small ? fmt::format(" with {:.2g} % of them", 100 * motion.work) : "");
}

void throw_driven(const std::string& motions)
{
  throw Error(ExitStatus::no_equilibrium,
              "no equilibrium: no support or contact resists these motions:" + motions +
                  "\nhold the body by a support, let a contact (perhaps with friction) reach it, or remove the load");
}

}  // namespace mortise::feti
