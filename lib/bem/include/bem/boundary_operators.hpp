// The boundary integral operators of linear elasticity on the surface of one body, by Galerkin's method with displacements u that
// are linear on each panel and continuous, and tractions t that are constant on each panel.
//
// With Kelvin's solution U(d) = (1 + nu) / (8 pi E (1 - nu)) ((3 - 4 nu) I / r + d d' / r^3), d = x - y, r = |d|, and T its
// traction in y,
//
//     V t = II U t,   K u = II T u,   D u = -II (traction in x of T) u:
//
// in a body without body forces V t = (M / 2 + K) u and D u + (M / 2 + K)' t = f, the nodal forces. All of them come from the
// kernels 1 / (4 pi r) and d d' / (4 pi r^3) and from the double layer of Laplace's equation, by Stokes' theorem with the
// tangential derivatives M_ij = n_j d_i - n_i d_j, which are constant on a panel:
//
//     K u = K_L u - V_L (M u) + 2 mu V (M u),
//     D_ij = mu (2 tr Y I - Y)_ij + (M' (2 mu V_L - 4 mu^2 V) M)_ij,   Y_ij = c_i' V_L c_j,   c = n x grad
//
// [Kupradze, Three-dimensional problems of elasticity, 1979; Han, Numer. Math. 68 (1994)].
//
// In plane strain, lengths over a unit beyond the size of the surface, so that V is positive definite,
//
//     U(d) = (1 + nu) / (4 pi E (1 - nu)) (-(3 - 4 nu) ln r I + d d' / r^2),   M u = (-u_2', u_1'),   ' = d / ds:
//
// K as above with Laplace's kernels -ln r / (2 pi) and n_y.d / (2 pi r^2), and
//
//     <D u, v> = E / (4 pi (1 - nu^2)) II u' . (-ln r I + d d' / r^2) v'.
//
// The choice of the unit adds a translation to V t, which vanishes for tractions in equilibrium, and nothing to K and D.
#pragma once

#include <Eigen/Core>

#include "bem/panels.hpp"
#include "fem/options.hpp"

namespace mortise::bem {

/// The kernels' double integrals over all pairs of panels. m panels, n nodes.
struct LayerIntegrals {
  Eigen::MatrixXd single;        ///< m x m, 1 / (4 pi r)
  Eigen::MatrixXd kelvin;        ///< 3 m x 3 m, U; unknown 3 * panel + component
  Eigen::MatrixXd double_layer;  ///< m x n, n_y . d / (4 pi r^3), linear in y
};
/// `accuracy`: of the quadrature, relative to the entries of neighbours.
LayerIntegrals integrate_layers(const Panels& panels, const fem::Material& material, double accuracy);

/// Which operators are made: V and K give tractions, D forces as well.
enum class Operators { of_tractions, all };

struct BoundaryOperators {
  Eigen::MatrixXd v;  ///< V, 3 m x 3 m
  Eigen::MatrixXd k;  ///< M / 2 + K, 3 m x 3 n
  Eigen::MatrixXd d;  ///< D, 3 n x 3 n; empty if not made
};
/// In space; `accuracy` as above.
BoundaryOperators boundary_operators(const Panels& panels, const fem::Material& material, double accuracy,
                                     Operators which = Operators::all);

/// In plane strain, from closed forms: 2 components instead of 3. For plane stress see plane_state.hpp.
BoundaryOperators boundary_operators(const PlanePanels& panels, const fem::Material& material, Operators which = Operators::all);

/// The unit of -ln r in a plane: four times the size of the surface.
double unit_of_length(const PlanePanels& panels);

/// Nodal forces M't, D n, of tractions t, D m, that are constant on each panel.
template <int D>
Eigen::VectorXd nodal_forces(const PanelsIn<D>& panels, const Eigen::VectorXd& t);

}  // namespace mortise::bem
