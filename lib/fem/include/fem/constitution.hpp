// What stresses depend on besides displacements.
#pragma once

#include "fem/materials.hpp"
#include "fem/options.hpp"
#include "fem/temperature.hpp"

namespace mortise::fem {

/// Of one subdomain.
struct Constitution {
  Materials materials;
  Formulation formulation = Formulation::standard;
  Temperature temperature_change = {};  ///< degrees
  Point acceleration = Point::Zero();   ///< the body force is density times this
};

}  // namespace mortise::fem
