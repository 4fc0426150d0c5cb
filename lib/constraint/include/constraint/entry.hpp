// A coefficient of a row.
#pragma once

#include "base/types.hpp"

namespace mortise::constraint {

struct Entry {
  Global node;
  int component;
  double coefficient;
};

}  // namespace mortise::constraint
