// What loads do to motions that nothing resists: nothing, what rounding and facets make of them, or more.
#pragma once

#include <string>

#include "feti/free_motions.hpp"

namespace mortise::feti {

/// Parts of the forces on the bodies of a free motion.
struct DriveLimits {
  double told = 0;     ///< what works more on it is told
  double refused = 0;  ///< what works more on it has no equilibrium
};

/// `opposed_loads`: the part of the forces on its bodies that are pressures and tractions which cancel, all round a bore or on two
/// sides: areas of meshes leave some of them. All other loads have resultants that meshes do not change, so that a motion that
/// hardly turns feels their exact component; of one that turns, facets move the centre of mass beside its axis by a part of their
/// arcs' height.
DriveLimits drive_limits(const FreeMotion& motion, double opposed_loads);

/// A load on a motion that nothing resists, which the solution holds.
struct UnresistedLoad {
  int body = 0;
  std::string motion;      ///< describe()
  bool turns = false;      ///< `force` is a moment
  double force = 0;        ///< along it, or about its axis
  double part = 0;         ///< FreeMotion::work: of the forces on its bodies
  double limit = 0;        ///< DriveLimits::told
  bool of_facets = false;  ///< facets of the mesh feel the motion, or stand for what slides
};

/// Of a motion that loads work on. `limit`: DriveLimits::told, `size`: of its first body.
UnresistedLoad unresisted_load(const FreeMotion& motion, double limit, double size);

}  // namespace mortise::feti
