// The nodes that the rows of contacts speak of.
#pragma once

#include <algorithm>
#include <vector>

#include "constraint/constraints.hpp"

namespace mortise::analysis {

/// Contact nodes without entries included; each once, ascending.
inline std::vector<Global> nodes_in_rows(const constraint::Contacts& contacts)
{
  std::vector<Global> nodes;
  for (const auto& entry : contacts.rows.entries) nodes.push_back(entry.node);
  for (const auto& node : contacts.nodes) nodes.push_back(node.node);
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return nodes;
}

}  // namespace mortise::analysis
