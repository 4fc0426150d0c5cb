// The deck's section `output`.
#pragma once

#include <string>
#include <vector>

#include "deck/description.hpp"

namespace mortise::io {

/// What is to be known of the inside of bodies.
struct InteriorOptions {
  bool cells = false;  ///< bodies of boundary elements are written with their cells, not with their skin
};

struct Options {
  std::string directory;  ///< absolute by the time it gets here
  std::vector<std::string> fields{"displacement", "von_mises", "stress"};
  InteriorOptions interior;
};

/// The keywords.
void describe(deck::Description<InteriorOptions>& d);
void describe(deck::Description<Options>& d);

}  // namespace mortise::io
