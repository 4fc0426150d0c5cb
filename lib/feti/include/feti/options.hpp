// The deck's section `solver`, as far as it concerns the subdomains.
#pragma once

#include <string>

namespace mortise::feti {

struct Options {
  std::string factorization = "cholmod";  ///< cholmod | klu2
};

}  // namespace mortise::feti
