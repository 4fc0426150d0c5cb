// A contact whose secondary faces are integrated over what lies opposite: what its rows are made of.
#pragma once

#include <memory>
#include <vector>

#include "rows/bond_owners.hpp"
#include "rows/opposed_sides.hpp"
#include "rows/rows_between.hpp"

namespace mortise::contact {

/// Heavy: moves, does not copy.
struct IntegratedContact {
  std::unique_ptr<OpposedSides> sides;
  RowsBetween between;        ///< at places between nodes
  std::vector<char> matches;  ///< of each surface node of a bond, see on_matching_faces(); of a contact empty
};

/// What the faces of both sides have in common. `comm` outlives the result. Collective.
IntegratedContact integrate(std::unique_ptr<OpposedSides> sides, const Communicator& comm);

/// Of a bond: this rank's secondary nodes that it covers.
std::vector<CoveredNode> covered_nodes(IntegratedContact& bond);

}  // namespace mortise::contact
