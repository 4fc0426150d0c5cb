// The same constraint rows at another state of the supports and contacts, for load steps: bounds change, rows do not.
#pragma once

#include <span>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "constraint/supports.hpp"

namespace mortise::constraint {

/// Gives `constraints` the values that supports prescribe in a new state. `prescribed`, as of dirichlet_rows(), and `supports`
/// belong to the new state, `before` to the state that the constraints were made for. Returns false, and changes nothing, if the
/// new state prescribes other components, or if something varies in space. Collective.
bool update_rhs(Constraints& constraints, std::vector<PrescribedDof> prescribed, std::span<const Support> supports,
                std::span<const Support> before, const Communicator& comm);

/// Adds `overlap`, a length, to the interference of one contact.
void add_interference(Contacts& contacts, int contact, double overlap);

/// Lets friction count slip from the present state: `jumps` are row . u of all contact rows of this rank, lengths. Bonded nodes
/// stay tied to where they were.
void remember_slip(Contacts& contacts, std::span<const double> jumps);

}  // namespace mortise::constraint
