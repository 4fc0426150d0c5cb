// What a surface in contact feels of rigid motions, apart from the angles between its facets.
#pragma once

#include <Eigen/Core>

#include "base/types.hpp"

namespace mortise::constraint {

/// One side of a contact on one body, with normal n. A rigid motion is (t, w): the velocity is v = t + w x (x - centre) / length.
/// Forms are quadratic in (t, w), mean values over the faces.
struct SlidingSurface {
  using Form = Eigen::Matrix<double, 6, 6>;
  int contact = 0;  ///< index into the deck's contacts
  bool secondary = true;
  int body = 0;
  Point centre = Point::Zero();
  double length = 1;
  Form whole = Form::Zero();     ///< of (n . v)^2
  Form of_faces = Form::Zero();  ///< of the square of the mean of n . v on each face
  Form smooth = Form::Zero();    ///< of the square of what n . v has in common with quadratic polynomials; of few faces the whole
  Form speed = Form::Zero();     ///< of |v|^2
  double tilt = 0;  ///< mean square of the angle (radians) between a face and the mean of those at its nodes, kinks apart
  double tilt_with_kinks = 0;  ///< the same with them
};

}  // namespace mortise::constraint
