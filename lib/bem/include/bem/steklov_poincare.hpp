// What a body's surface knows of its inside: forces and tractions from displacements.
//
//     S = D + (M/2 + K)' V^-1 (M/2 + K),   t = V^-1 (M/2 + K) u
//
// [Steinbach, Numerical Approximation Methods for Elliptic Boundary Value Problems, Springer 2008, section 12.3]. Quadrature is
// made exact for fields that are linear in space, with tractions T n of a constant stress: K gets (V T - K U) (U'U)^-1 U' more
// for the D (D + 1) of them in D dimensions, U and T, and D a symmetric term such that S U = M'T. So rigid motions have no forces
// but by rounding. Plane models: plane strain; for plane stress see plane_state.hpp.
#pragma once

#include <Eigen/Core>

#include "bem/panels.hpp"
#include "fem/options.hpp"

namespace mortise::bem {

/// Accuracy of the quadrature in space, for fields that are not linear, relative to the entries of neighbours; lines have closed
/// forms.
inline constexpr double usual_accuracy = 1e-4;

/// S, D n x D n, symmetric, unknown D * node + component. Takes about 50 m n numbers for a moment in space, 24 m n in a plane (m
/// panels, n nodes). Throws Error(bad_input) where V is not positive definite, which is a matter of panels that cut each other.
template <int D>
Eigen::MatrixXd steklov_poincare(const PanelsIn<D>& panels, const fem::Material& material, double accuracy = usual_accuracy);

/// t, D m x columns, of displacements u, D n x columns: unknown D * panel + component. Costs about a third of S.
template <int D>
Eigen::MatrixXd tractions(const PanelsIn<D>& panels, const fem::Material& material, const Eigen::MatrixXd& u,
                          double accuracy = usual_accuracy);

}  // namespace mortise::bem
