#include "io/options.hpp"

namespace mortise::io {

void describe(deck::Description<Options>& d)
{
  d.help("What is written where.");
  d.key("directory", &Options::directory, "Relative to the deck; default: <deck name>.out beside the deck.");
  d.key("fields", &Options::fields, "Volume fields to write.").one_of({"displacement", "von_mises", "stress"});
}

}  // namespace mortise::io
