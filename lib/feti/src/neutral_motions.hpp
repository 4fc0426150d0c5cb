// Rigid motions of bodies that a solution leaves open: no row that carries a force feels them.
#pragma once

#include "body_rows.hpp"

namespace mortise::feti {

/// What rows of a solution feel of the bodies' motions. The rows are those from JumpOperator::Ranges::dirichlet on.
struct FeltMotions {
  SparseMatrix rows;       ///< rows of this rank x amplitudes of all bodies, in lengths
  Eigen::VectorXd closed;  ///< 1: a row that holds, 0: an open contact
  Eigen::VectorXd gap;     ///< of open contacts' normal rows; infinite for all others
};

/// Of each row of this rank the largest of `forces`, of these rows, on that of its bodies where it is smallest: what a force is
/// little beside. 0 if one of its bodies is left out, or if it feels none, as what presses on the side of a ring; `left_out` has
/// one entry for each body of all. Collective.
Eigen::VectorXd largest_on_bodies(const SparseMatrix& rows, const Eigen::VectorXd& forces, const std::vector<bool>& left_out,
                                  const Communicator& comm);

/// The change of the amplitudes that takes the present ones, `now`, as near to 0 as can be: along motions that no closed row
/// feels (to 1e-6 of a row), and so far that no gap closes; what closes a gap counts as closed, and motions beside it go on. 0
/// where there is no such motion. The same on every rank. Collective.
Eigen::VectorXd towards_rest(const FeltMotions& felt, const Eigen::VectorXd& now, const Communicator& comm);

/// Of each body whether `change`, amplitudes of all, takes it somewhere else rather than turns it where it is. None do if loads
/// work on none: what contact forces alone push along, rounding does.
std::vector<bool> travellers(const Eigen::VectorXd& change, const Bodies& bodies);

/// The mean amplitudes of each body's motions in `u`, over its nodes. Collective.
Eigen::VectorXd mean_amplitudes(const partition::Decomposition& decomposition, const Bodies& bodies,
                                const std::vector<Eigen::VectorXd>& u, const Communicator& comm);

}  // namespace mortise::feti
