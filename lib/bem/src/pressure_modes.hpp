// Uniform pressure, on which nearly incompressible materials hang.
#pragma once

#include "bem/boundary_operators.hpp"

namespace mortise::bem {

/// On each closed surface Gamma of the panels the dilation u = x with t = p n, p = E / (1 - 2 nu), is a solution within Gamma,
/// and with its operators exact for a point y of any of the surfaces (c = 1 or 0: those of M / 2 + K for u = const., with the
/// sign changed)
///
///     p V n = (M / 2 + K) x + c y,      p (M / 2 + K)' n = c' p M' n - D x:
///
/// V n and K'n - M'n vanish like 1 - 2 nu, so that for nu near 1/2 errors of quadrature in them would be all that is left.
/// Changes V (symmetrically) and K by terms of low rank, of the size of that error, so that both hold. `single`: V_L, from
/// LayerIntegrals.
void make_exact_for_pressure(const Panels& panels, const fem::Material& material, const Eigen::MatrixXd& single,
                             BoundaryOperators& operators);

}  // namespace mortise::bem
