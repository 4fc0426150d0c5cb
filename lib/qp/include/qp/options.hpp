// The deck's section `solver`, as far as it concerns the quadratic programme.
#pragma once

#include <string>

#include "deck/description.hpp"

namespace mortise::qp {

struct Options {
  std::string algorithm = "auto";
  deck::OrAuto<double> tolerance;         ///< relative: reduced projected gradient and equality residual over ||P d||
  deck::OrAuto<int> max_multiplications;  ///< with F, in the whole run; auto: see Budget
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::qp
