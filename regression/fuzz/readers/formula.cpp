// A formula of a deck, and its values.
#include "deck/formula.hpp"

#include <stdexcept>

#include "input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  try {
    const mortise::deck::Formula formula(std::string(reinterpret_cast<const char*>(data), size));
    formula(mortise::Point(0.5, -1, 2), 0.25);
    formula.at(2, 1)(mortise::Point(0, 0, 0), 0);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
