// What supports and contacts feel of the rigid motions of whole bodies, where unknowns give way, and which of it facets excuse.
#pragma once

#include "feti/rigid_modes.hpp"

namespace mortise::feti {

// Facets excuse the normal rows of contacts alone: what supports, bonds and friction feel of a motion counts this often.
inline constexpr double support_weight = 1e3;

// All bodies and what loads do to their motions.
struct Bodies : RigidModes {
  Eigen::VectorXd force;        // sum of |nodal forces| of each body
  Eigen::VectorXd generalised;  // work of the loads on each unit motion
};

// Collective.
Bodies loaded_bodies(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                     const std::vector<Eigen::VectorXd>& load, const Communicator& comm);

// The rows of supports and contacts that this rank owns, over the amplitudes of all bodies, in lengths.
struct BodyRows {
  SparseMatrix values;
  Local first_contact;
  Eigen::VectorXd weight;  // of each row: how often it counts
  Eigen::VectorXd fixed;   // 1: the angles of facets are no excuse for what it feels
};

// What `unknowns` give way to is taken out of the rows, and what their forces work added to `bodies`. Collective.
BodyRows body_rows(const JumpOperator& jump, Bodies& bodies, const SparseMatrix& g, const constraint::Constraints& constraints,
                   std::span<const Unknown> unknowns, const Communicator& comm);

// The bodies that contact nodes join, those that `joins` marks, with the others alone: each body by itself first, then the sets
// of several. Collective.
std::vector<std::vector<int>> units(const BodyRows& rows, const constraint::Contacts& contacts, const std::vector<bool>& joins,
                                    const Bodies& bodies, const Communicator& comm);

// The free motions of bodies that move as one, all others at rest: see find_free_motions(). Collective.
std::vector<FreeMotion> motions_of_unit(const Bodies& bodies, const BodyRows& rows, const constraint::Contacts& contacts,
                                        const std::vector<int>& unit,
                                        std::span<const constraint::SlidingSurface> sliding_surfaces, const Communicator& comm);

}  // namespace mortise::feti
