// Nodes of supports whose places do not matter.
#pragma once

#include "constraint/supports.hpp"

namespace mortise::constraint {

inline std::vector<SupportNodes> anywhere(std::vector<std::vector<Global>> ids)
{
  std::vector<SupportNodes> nodes;
  for (auto& of_support : ids) {
    const auto count = of_support.size();
    nodes.push_back({std::move(of_support), std::vector<Point>(count, Point::Zero())});
  }
  return nodes;
}

}  // namespace mortise::constraint
