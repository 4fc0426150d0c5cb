// The tables of results.h5.
#pragma once

#include <vector>

#include "io/results.hpp"
#include "post/interior.hpp"

namespace mortise::output {

/// `nodes/..`: each node from its copy in the lowest subdomain. `displacement`: of each subdomain.
std::vector<io::Table> node_tables(const partition::Decomposition& decomposition, const partition::Interface& interface,
                                   const std::vector<Eigen::VectorXd>& displacement, const post::StressField& stress);

/// `cells/..`: connectivity and what belongs to cells; of boundary elements the cells are the panels. Collective.
std::vector<io::Table> cell_tables(const partition::Decomposition& decomposition, const post::StressField& stress,
                                   const Communicator& comm);

/// `contact/points`: rows by contact and node, whatever ranks they come from. Collective.
io::Table contact_table(const std::vector<contact::ContactNodeState>& nodes, const Communicator& comm);

/// `dual/multipliers`: the force of each row of B that is this rank's, in the order of its rows; in units of force, as
/// feti::DualProblem::forces() says.
io::Table multiplier_table(const feti::DualProblem& problem, const Vector& lambda);

/// `interior/..` of nodes inside boundary elements, which have the numbers after all others, and `points/..` of the deck's
/// points; those that are asked for. Collective.
std::vector<io::Table> interior_tables(const partition::Decomposition& decomposition, const post::Probes& probes,
                                       const post::Interior& interior, const Communicator& comm);

}  // namespace mortise::output
