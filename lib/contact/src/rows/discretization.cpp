#include "rows/discretization.hpp"

#include <algorithm>
#include <array>

namespace mortise::contact {

std::span<const DiscretizationKind> discretizations()
{
  static constexpr std::array table{
      DiscretizationKind{"mortar", "dual multipliers, integrated segment by segment.", make_mortar},
      DiscretizationKind{"node_to_segment",
                         "each secondary node against the primary face opposite; no patch test where the meshes do not match.",
                         make_node_to_segment}};
  return table;
}

std::unique_ptr<Discretization> make_discretization(std::string_view name, const TwoSides& sides)
{
  const auto table = discretizations();
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& kind) { return kind.name == name; });
  return (found == table.end() ? table.front() : *found).make(sides);
}

}  // namespace mortise::contact
