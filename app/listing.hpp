// What --check says about the mesh: its bodies and boundaries, so that a face can be found by where it is.
#pragma once

#include "base/context.hpp"
#include "fem/options.hpp"
#include "partition/decomposition.hpp"

namespace mortise {

/// Bodies with cells and extent; boundaries with area, centre and mean normal. Of instances the first of each body. Collective.
void print_listing(const partition::Decomposition& decomposition, fem::Kinematics kinematics, const Context& context);

}  // namespace mortise
