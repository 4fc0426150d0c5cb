// Integrals over one flat triangle in closed form.
#pragma once

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

/// I n.d / r^3 alone [van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983)].
double solid_angle(const Panels& panels, std::size_t panel, const Point& x);

}  // namespace mortise::bem
