// Rigid motions of whole bodies by their amplitudes, and what rows feel of them. A subdomain's part of such a motion is in its
// kernel, so that G and the motions' coordinates there tell, without a sweep over nodes:
//
//     v = R A a,   row . v = S^-1 B v = S^-1 G'A a,
//
// a the amplitudes of all bodies, A their coordinates in the kernels of the clusters, S how rows of B are scaled.
#pragma once

#include "feti/free_motions.hpp"

namespace mortise::feti {

/// Of each body rigid_motion_count() motions, one body after the other, each scaled so that |v| is about 1 on the body:
/// translations along x, y, z, then rotations about its principal axes over BodyFrame::arms; in the plane two and one; in
/// axisymmetry the one along the axis. So amplitudes are lengths. The same on every rank.
struct RigidModes {
  fem::Kinematics kinematics;
  int modes;  ///< of each body
  std::vector<BodyFrame> frames;
  SparseMatrix aggregate;  ///< A: kernels x (bodies * modes)
};

/// Those of all bodies of the catalogue. `clusters` are of `decomposition`. Collective.
RigidModes rigid_modes(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                       const Communicator& comm);

/// Rows of supports, springs, contacts and gauges, as they were given, over the amplitudes: S^-1 G'A of the rows that this rank
/// owns, from JumpOperator::Ranges::dirichlet on (gluing feels no rigid motion of a body). Over amplitudes it is a length.
/// `g`: of coarse_rows(), or with rows of other unknowns behind, as DualProblem::equality() has it.
SparseMatrix rows_of_bodies(const JumpOperator& jump, const SparseMatrix& g, const RigidModes& bodies);

}  // namespace mortise::feti
