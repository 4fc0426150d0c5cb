// The same constraint rows at another state of the supports and contacts, for load steps: bounds change, rows do not.
#pragma once

#include <span>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "constraint/supports.hpp"

namespace mortise::constraint {

/// Takes over what supports prescribe now. `prescribed`, as of dirichlet_rows(), and `supports` belong to the new state, `before`
/// to that which the constraints were made for. Returns false, and changes nothing, if other components are prescribed than
/// before, or if something varies in space. Collective.
bool update_rhs(Constraints& constraints, std::vector<PrescribedDof> prescribed, std::span<const Support> supports,
                std::span<const Support> before, const Communicator& comm);

/// Adds `overlap` to the interference of one contact.
void add_interference(Contacts& contacts, int contact, double overlap);

/// From now on friction counts slip from here: `jumps` are row . u of all contact rows of this rank, in length units. Bonded
/// points stay tied to where they were.
void remember_slip(Contacts& contacts, std::span<const double> jumps);

}  // namespace mortise::constraint
