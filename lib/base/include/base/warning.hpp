// What a run tells its user to look at: found before or after the solution, printed in the log's last lines and kept in
// summary.json.
#pragma once

#include <optional>
#include <string>

#include "base/types.hpp"

namespace mortise {

/// Texts are for an engineer; kinds are for programs and a promise: see docs/design/warnings.md.
struct Warning {
  std::string kind;  ///< "large_displacement"
  std::string text;  ///< what is the matter, with numbers and the place
  std::string cure;  ///< what to do about it
  /// Where, as far as it is known: coordinates, names of a body, a boundary, a contact.
  std::optional<Point> at = {};
  std::string body = {}, boundary = {}, contact = {};
  double value = 0, limit = 0;  ///< what was found, and from where on it counts
  std::string step = {};        ///< the load step, if the deck has some
};

}  // namespace mortise
