// Plane models in terms of plane strain, for which the operators are made.
//
// In the plane, plane stress of a material of Young's modulus E and Poisson's ratio nu is plane strain of one of the same shear
// modulus and nu / (1 + nu). A change of temperature of plane strain expands the plane by (1 + nu) alpha a degree, as across it
// nothing gives way.
#pragma once

#include "fem/constitution.hpp"

namespace mortise::bem {

/// The material that has in plane strain, in the plane, what `material` has in `kinematics`: itself in space. Not for
/// axisymmetry.
fem::Material in_plane(const fem::Material& material, fem::Kinematics kinematics);

/// The stress ZZ across a plane model, of the sum of XX and YY: nu (XX + YY) - E alpha dT in plane strain, 0 in plane stress.
/// 0 for solids.
double stress_across_plane(const fem::Constitution& constitution, fem::Kinematics kinematics, double sum);

}  // namespace mortise::bem
