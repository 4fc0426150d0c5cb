// The text of a deck: YAML, keys, values and formulas, and the checks that cross sections.
#include "model/deck.hpp"

#include "input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  mortise::may_refuse([&] {
    mortise::deck::Document document(std::string(reinterpret_cast<const char*>(data), size), "deck.yaml", {});
    mortise::model::read_deck(document, "");
    document.check();
  });
  return 0;
}
