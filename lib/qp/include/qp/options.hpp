// The deck's section `solver`, as far as it concerns the quadratic programme.
#pragma once

#include <string>

#include "deck/description.hpp"

namespace mortise::qp {

struct Options {
  static constexpr const char* automatic = "auto";  ///< the program chooses a solver, and may change it
  std::string algorithm = automatic;                ///< auto, or a name of solvers()
  deck::OrAuto<double> tolerance;         ///< of gradient and equality residual over ||P d||; auto: by the error, see Goal
  deck::OrAuto<int> max_multiplications;  ///< products with F, in the whole run; auto: see Budget
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::qp
