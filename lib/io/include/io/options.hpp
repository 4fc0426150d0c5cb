// The deck's section `output`.
#pragma once

#include <string>
#include <vector>

#include "deck/description.hpp"

namespace mortise::io {

struct Options {
  std::string directory;  ///< absolute by the time it gets here
  std::vector<std::string> fields{"displacement", "von_mises", "stress"};
};

/// The keywords.
void describe(deck::Description<Options>& d);

}  // namespace mortise::io
