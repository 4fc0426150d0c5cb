#include "feti/drives.hpp"

#include <algorithm>

namespace mortise::feti {

namespace {

// A load that works less than this on a free motion, relative to the forces on the body, counts as rounding: of numbers typed
// with six digits, and of sums of nodal forces.
constexpr double no_work = 1e-6, no_work_of_sums = 1e-9;
// What turns less than this is a translation, as in describe().
constexpr double hardly_turns = 2e-2;
// Of the forces, along an axis that is drawn askew and typed with a few digits.
constexpr double no_component = 1e-4;
// The axis of a motion that lets facets slide along themselves, and the centre of mass beside it.
constexpr double work_of_facets = 1e-3, part_of_sagitta = 0.5, told_part_of_sagitta = 0.3;
// Of pressures that cancel: what the areas of two sides differ by, whose rims are polygons of their own; and what of that may be
// left out, also where surfaces slide along themselves exactly.
constexpr double part_of_opposed = 1e-2, work_of_areas = 1e-3;
// How well the direction of a motion is known that rows feel something of.
constexpr double of_resistance = 3, told_of_resistance = 10;

}  // namespace

DriveLimits drive_limits(const FreeMotion& motion, double opposed_loads)
{
  const double facets = std::max(motion.sliding ? work_of_facets : 0.0, part_of_sagitta * motion.sagitta);
  const double felt = motion.resistance;
  if (motion.turning > hardly_turns)
    return {std::max({no_work, told_part_of_sagitta * motion.sagitta, told_of_resistance * felt}),
            std::max({no_work, facets, of_resistance * felt})};
  const double cancels = part_of_opposed * opposed_loads, unsure = std::max(motion.turning, cancels);
  return {std::max({no_work_of_sums, motion.turning, std::min(cancels, std::max(facets, no_work)), told_of_resistance * felt}),
          std::max({no_work, std::min(facets, std::max(no_component, unsure)), std::min(cancels, work_of_areas),
                    of_resistance * felt})};
}

UnresistedLoad unresisted_load(const FreeMotion& motion, double limit, double size)
{
  const auto& first = motion.motions.front();
  UnresistedLoad result;
  result.body = first.body;
  result.motion = describe(first, size);
  result.turns = motion.turning > hardly_turns;
  const double speed = result.turns ? first.rotation.norm() : first.translation.norm();
  result.force = speed > 0 ? motion.work * motion.force / speed : 0;
  result.part = motion.work;
  result.limit = limit;
  result.of_facets = motion.sagitta > 1e-6;
  return result;
}

}  // namespace mortise::feti
