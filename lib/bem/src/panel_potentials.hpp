// Integrals over one flat triangle in closed form.
#pragma once

#include <array>

#include "bem/panels.hpp"

namespace mortise::bem {

/// With d = x - y, r = |d|, y on the panel.
struct PanelPotentials {
  double single;           ///< I 1 / r
  double angle;            ///< I n.d / r^3: the solid angle, positive in front
  Point attraction;        ///< I d / r^3
  Point tensor;            ///< I d (d.c) / r^3
  Eigen::Matrix3d triple;  ///< I 3 d d' (d.c) / r^5
};
/// Of a vector c, for x anywhere; at no more than 1e-12 of an edge's length from its line the logarithms are those of this
/// distance. By the divergence theorem in the plane, with d = h n - rho: grad 1 / r = -rho / r^3, grad rho / r = P / r - rho rho'
/// / r^3, ... turn all integrals into the solid angle and integrals along the edges. Errors are those of rounding for x no
/// farther than some ten times the panel's size.
PanelPotentials panel_potentials(const Panels& panels, std::size_t panel, const Point& x, const Point& c);

/// What the integrals over pairs of panels need of one of them, at x.
struct LayerPotentials {
  double single;                       ///< I 1 / r
  std::array<double, 6> tensor;        ///< I d d' / r^3: XX YY ZZ XY YZ XZ
  Point attraction;                    ///< I d / r^3
  std::array<double, 3> double_layer;  ///< I n.d / r^3 phi_k(y), phi_k linear and 1 in corner k
};
/// As panel_potentials, with the same limits. phi_k(y) = phi_k(x) - grad phi_k.d.
LayerPotentials layer_potentials(const Panels& panels, std::size_t panel, const Point& x);

/// I n.d / r^3 alone [van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983)].
double solid_angle(const Panels& panels, std::size_t panel, const Point& x);

}  // namespace mortise::bem
