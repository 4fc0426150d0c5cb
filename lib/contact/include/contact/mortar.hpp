// From two surfaces to the rows of a contact: by mortar with dual multipliers, or the discretization that the deck names.
//
// The multiplier space is biorthogonal to the secondary side's shape functions, integral psi_i phi_j = delta_ij integral phi_j
// [Wohlmuth, SIAM J. Numer. Anal. 38 (2000); Popp, Gitterle, Gee, Wall, IJNME 83 (2010)], integrated segment by segment, so that
// each row speaks of one secondary node and the primary nodes opposite. It is built on the covered part of each face, which keeps
// constant pressures exact at the border of the overlap. Nodes that can have no multiplier (prescribed along the normal, or
// hardly covered) leave theirs to the other nodes of the face [in the spirit of Popp et al., SIAM J. Sci. Comput. 35 (2013),
// boundary modification].
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "contact/fit.hpp"
#include "contact/options.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// The two sides of a contact, this rank's faces of each. Contacts that have their primary side in common, as the rollers of a
/// ring, share it; an obstacle has none; that of a cyclic pair is rotated to where it meets the secondary side (see cyclic.hpp).
struct Pair {
  Options options;
  mesh::Surface secondary;
  std::shared_ptr<const mesh::Surface> primary;
};

/// For each pair how far apart its two sides may lie to meet, a length: the deck's search_distance, or a tenth of the extent of
/// the smaller side, but at least the size of a face. Collective.
std::vector<double> search_distances(std::span<const Pair> pairs, const Communicator& comm);

/// The contact rows of all pairs; contact c of ContactNode is pairs[c]. Rows stand on any rank, each once; they do not depend on
/// the number of ranks, to the last bit. Frictionless pairs have normal rows only. In axisymmetry areas and forces are those of
/// the whole turn.
///
/// `prescribed`, `skew_supports`: the supports of this rank. `curved_faces`: the faces of this rank whose geometry is known.
/// `initial_gaps`, unless null, gets the initial gap of each pair, the same on every rank. Throws Error(bad_input) if the cuts of
/// a sector do not lie on each other, or if supports alone push the sides of a contact into each other or those of a bond apart.
/// Collective.
constraint::Contacts discretize(std::span<const Pair> pairs, std::span<const constraint::PrescribedDof> prescribed,
                                fem::Kinematics kinematics, const Communicator& comm,
                                std::span<const constraint::SkewSupport> skew_supports = {},
                                std::span<const CurvedFace> curved_faces = {}, std::vector<InitialGap>* initial_gaps = nullptr);

}  // namespace mortise::contact
