// The deck's section `output`.
#pragma once

#include <string>
#include <vector>

namespace mortise::io {

struct Options {
  std::string directory;  ///< absolute by the time it gets here
  std::vector<std::string> fields{"displacement", "von_mises", "stress"};
};

}  // namespace mortise::io
