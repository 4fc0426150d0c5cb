// Rows that keep free rigid motions at zero.
#pragma once

#include <vector>

#include "feti/free_motions.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

/// The equality row that says that the mean of the motion, weighted with the stiffness of the nodes, is zero: D v / ||v||_D,
/// v the motion at all unknowns, a unit vector in D^-1; over ||v||_D it is the amplitude of v. `alone`: no other free motion
/// moves its bodies. If it rotates a body, v is then the rotation about the centre of that stiffness: what the row holds, of what
/// facets make of the loads, is a couple, and no force across the body. Collective.
SubdomainRow gauge(const FreeMotion& motion, bool alone, const partition::Decomposition& decomposition,
                   const std::vector<std::vector<double>>& nodal_stiffness, const Communicator& comm);

}  // namespace mortise::feti
