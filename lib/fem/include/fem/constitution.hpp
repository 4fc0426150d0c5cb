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
  Temperature temperature_change = {};
  Point acceleration = Point::Zero();
};

}  // namespace mortise::fem
