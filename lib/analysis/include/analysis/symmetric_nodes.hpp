// Nodes whose stresses are those of a body that goes on beyond its planes of symmetry, or beyond the cuts of its sector.
//
// On a flat part of the surface that a support prescribes along the normal alone, at whatever value, the traction along the
// surface vanishes. At its edges the body may go on in its mirror image, with all that acts on other faces, so that shear cancels
// there as well; not where
//
// - a load along the plane's normal shears a face beside it, or a contact with friction or a bond may, since supports do not hold
//   both of its sides in the plane;
// - anything acts along the face itself: a load, a second support, a foundation, friction, a bond;
// - a coupling takes part;
// - the body reaches beyond the plane, or two such planes have more than a right angle between them: stress has no limit there,
//   or the surface is curved.
//
// Nodes of a sector's cuts are one with those of the other cut, turned, where the bond ties one to one. In axisymmetry the axis
// is on all planes through it.
#pragma once

#include "analysis/rows.hpp"
#include "partition/node_directory.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::analysis {

/// In the state of `rows`, the same for any number of ranks. Collective.
post::SymmetricNodes find_symmetric_nodes(const model::Model& model, const Rows& rows, const partition::NodeDirectory& directory,
                                          const partition::Interface& interface, const Communicator& comm);

}  // namespace mortise::analysis
