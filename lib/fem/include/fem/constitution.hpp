// What stresses depend on besides displacements.
#pragma once

#include "fem/materials.hpp"
#include "fem/options.hpp"

namespace mortise::fem {

/// Of one subdomain.
struct Constitution {
  Materials materials;
  Formulation formulation = Formulation::standard;
  double temperature_change = 0;  ///< degrees
  Point acceleration = Point::Zero();
};

}  // namespace mortise::fem
