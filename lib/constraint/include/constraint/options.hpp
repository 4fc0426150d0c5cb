// The deck's section `supports`.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace mortise::constraint {

/// Prescribed displacement of a boundary; a component without a value is free.
struct SupportOptions {
  std::string boundary;
  std::array<std::optional<double>, 3> displacement;
};

}  // namespace mortise::constraint
