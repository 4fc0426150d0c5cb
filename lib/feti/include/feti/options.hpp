// The deck's section `solver`, as far as it concerns the subdomains.
#pragma once

#include <string>

#include "deck/description.hpp"

namespace mortise::feti {

struct Options {
  std::string factorization = "cholmod";  ///< see DirectSolver: cholmod | cholmod_plain | klu2
  std::string factor_precision = "auto";  ///< auto | double | single
  std::string preconditioner = "lumped";  ///< see preconditioners(): none | lumped | dirichlet, of face Newton
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::feti
