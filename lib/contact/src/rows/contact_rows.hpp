// The rows of one contact: chooses the surface nodes that carry multipliers, and writes the rows of each.
#pragma once

#include <vector>

#include "constraint/constraints.hpp"
#include "contact/fit.hpp"
#include "gaps/one_surface.hpp"
#include "rows/integrated_contact.hpp"
#include "rows/sector_cuts.hpp"
#include "rows/support_conflicts.hpp"

namespace mortise::contact {

/// Nodes of a bond's secondary side at which others have rows, ascending.
struct OthersNodes {
  std::vector<Global> of_contacts;  ///< that are not bonded
  std::vector<Global> of_bonds;     ///< to which they belong
};

/// What is found on the way, of this rank's nodes.
struct RowsFound {
  InitialGap initial_gap;
  CutFit fit;  ///< of cuts of sectors
  Conflicts conflicts;
};

/// Appends the rows at the nodes that are this rank's. `gap`: of no nodes yet, with the lengths InitialGap::touching and face.
/// `supports`: those that `contact` was made with; `curved`: of the geometry. Collective.
RowsFound add_rows(IntegratedContact contact, const OthersNodes& others, const InitialGap& gap, const SupportDirectory& supports,
                   const CurvedFaces& curved, constraint::Contacts& contacts, const Communicator& comm);

}  // namespace mortise::contact
