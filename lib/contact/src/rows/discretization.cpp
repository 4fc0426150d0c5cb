#include "rows/discretization.hpp"

#include <algorithm>
#include <array>

#include "contact/options.hpp"

namespace mortise::contact {

std::span<const DiscretizationKind> discretizations()
{
  static constexpr std::array table{
      DiscretizationKind{"mortar", "dual multipliers, integrated segment by segment.", true, make_mortar},
      DiscretizationKind{"node_to_segment",
                         "each secondary node against the primary face opposite; no patch test where the meshes do not match.",
                         false, make_node_to_segment}};
  return table;
}

const DiscretizationKind& discretization_kind(std::string_view name)
{
  const auto table = discretizations();
  const auto found = std::ranges::find(table, name, &DiscretizationKind::name);
  return found == table.end() ? table.front() : *found;
}

bool sides_are_alike(const Options& options)
{
  return discretization_kind(options.discretization).sides_alike;
}

}  // namespace mortise::contact
