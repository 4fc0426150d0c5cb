// Boundaries coupled to a point, through which they are loaded and held. The point p moves by U and rotates by the small angles T
// about itself; x is a node of the boundary.
//
// Rigid: every node follows, u(x) = U + T x (x - p). What is not prescribed of U and T is unknown, and balances the load.
//
// Distributing: the point follows, U and T are the mean motion of the boundary by area. A force F and a moment M are spread over
// the boundary as the traction F / A + (I^-1 M) x (x - c), A its area, c its centre and I its second moment of area about c; the
// boundary stays flexible.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "constraint/constraints.hpp"
#include "deck/description.hpp"
#include "mesh/mesh.hpp"

namespace mortise::constraint {

/// One entry of the deck's section `couplings`.
struct CouplingOptions {
  std::string boundary;
  std::array<double, 3> point{0, 0, 0};  ///< p
  std::string kind = "distributing";     ///< or "rigid"
};

/// The keywords.
void describe(deck::Description<CouplingOptions>& d);

/// This rank's rows of rigid couplings: one for each node of the boundary and component. `surfaces`: of each coupling, this
/// rank's faces; empty for distributing ones. `first_support` + i is the number that the rows of the i-th one carry in
/// PrescribedDof::support. Each pair (node, component) stands once over all ranks, on rank node % ranks, ascending. Throws
/// Error(bad_input) if two couplings share a node. Collective.
std::vector<PrescribedDof> coupled_rows(std::span<const Coupling> couplings, std::span<const mesh::Surface> surfaces,
                                        int first_support, int dimension, const Communicator& comm);

/// A component of a rigid coupling's motion that is unknown: row . u = bound + part s with the unknown s.
struct UnknownMotion {
  int coupling, component;  ///< index into Constraints::couplings; 0 to 2: of U, 3 to 5: of T
  double unit;              ///< the motion for s = 1: an angle is measured at the boundary's distance from the point
  double force;             ///< that works on s
  struct Row {
    std::size_t row;  ///< of Constraints::prescribed
    double part;
  };
  std::vector<Row> rows;  ///< those of this rank
};

/// All unknown motions, the same on every rank but for `rows`, which are those of this rank.
std::vector<UnknownMotion> unknown_motions(const Constraints& constraints, int dimension);

/// Throws Error(bad_input) where a mean motion is prescribed otherwise than supports that hold all of its nodes have it, or than
/// another coupling of the same boundary does. Collective.
void require_consistent(std::span<const MeanMotion> motions, std::span<const PrescribedDof> prescribed,
                        std::span<const Coupling> couplings, const Communicator& comm);

/// Whether both prescribe the same components of the same couplings.
bool same_unknowns(std::span<const Coupling> a, std::span<const Coupling> b);

}  // namespace mortise::constraint
