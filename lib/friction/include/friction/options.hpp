// The deck's section `friction_loop`: the fixed point of Coulomb friction over Tresca problems.
#pragma once

#include "deck/description.hpp"

namespace mortise::friction {

struct Options {
  double tolerance = 1e-4;  ///< on the relative change of the slip bounds
  int max_steps = 50;
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::friction
