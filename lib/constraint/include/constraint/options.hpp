// The deck's section `supports`.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "deck/description.hpp"

namespace mortise::constraint {

/// Prescribed displacement of a boundary, or motion of a coupling's point; a component without a value is free.
struct SupportOptions {
  std::string boundary;
  std::array<std::optional<double>, 3> displacement;
  std::optional<double> normal = {};                   ///< along the boundary's own outward normal
  std::string name = {};                               ///< default: the boundary or coupling
  std::string coupling = {};                           ///< instead of a boundary
  std::array<std::optional<double>, 3> rotation = {};  ///< of a coupling: angles about the axes through its point
};

/// The keywords.
void describe(deck::Description<SupportOptions>& d);

}  // namespace mortise::constraint
