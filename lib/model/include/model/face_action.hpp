// What supports and loads do to the traction at the nodes of faces: which planes are free of shear, as planes of symmetry are.
#pragma once

#include <array>

#include "base/types.hpp"

namespace mortise::model {

/// One thing that acts on one face, at one of its nodes.
struct FaceAction {
  enum class Kind {
    prescribed,  ///< a support prescribes the displacement along `normal`, and leaves the face free to slide along itself
    tangential,  ///< a support acts along `direction`, which is not normal to the face
    pushed,      ///< a load acts along `direction`, or a contact, tangential to its own surface
    coupled      ///< the node belongs to a coupling
  };
  Global node;
  std::array<double, 3> at, normal, direction;  ///< the node's place, and unit vectors; `normal` points out of the body
  double size;                                  ///< the longest distance of two corners of the face
  Global face;                                  ///< partition::face_number(); -1 of the axis of revolution
  Kind kind;
};

/// The pressure of all loads on one face, at one of its nodes.
struct FacePressure {
  Global node;
  std::array<double, 3> normal;  ///< unit, out of the body
  double pressure;               ///< not a number where springs push along the normal, or a formula has no value
  Global face;                   ///< partition::face_number()
};

}  // namespace mortise::model
