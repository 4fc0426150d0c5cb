// A coefficient of a row.
#pragma once

#include "base/types.hpp"

namespace mortise::constraint {

/// The term coefficient * u(node, component).
struct Entry {
  Global node;
  int component;  ///< 0, 1, 2
  double coefficient;
};

}  // namespace mortise::constraint
