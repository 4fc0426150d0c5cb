// Contact as one dual problem leaves it, for another one of the same model: other components prescribed, or other subdomains.
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "base/communicator.hpp"
#include "feti/dual_problem.hpp"
#include "qp/solution.hpp"

namespace mortise::analysis {

/// A contact node by what does not change: contact, node, and its place among the contact nodes there.
using NodeKey = std::tuple<int, Global, int>;

/// Forces and gaps of contact nodes, in physical units.
class CarriedContact {
 public:
  /// Those of the nodes of this rank, at multipliers with their gradient.
  CarriedContact(const feti::DualProblem& problem, const qp::Solution& solution);
  /// Those of all ranks, each node on rank node % ranks. Collective.
  CarriedContact spread(const Communicator& comm) const;

  /// Sets what is known of the contact rows of another problem on this rank; `forces`, `gaps`: of all its rows, see
  /// feti::DualProblem::forces() and gaps().
  void put(const feti::DualProblem& problem, Eigen::VectorXd& forces, Eigen::VectorXd& gaps) const;
  /// Of what is spread: multipliers and gradient of another problem that know of contact alone, good for the states of its
  /// constraints. Collective.
  qp::Solution states_for(const feti::DualProblem& problem, const Communicator& comm) const;

 private:
  struct Values {
    double normal = 0;
    Point tangential = Point::Zero();
  };
  struct Node {
    Values force, gap;
  };
  CarriedContact() = default;
  CarriedContact exchange(const std::vector<std::vector<NodeKey>>& to, const Communicator& comm) const;
  // Of what is spread, the nodes that this rank has.
  CarriedContact at(const constraint::Contacts& contacts, const Communicator& comm) const;

  std::map<NodeKey, Node> nodes_;
};

}  // namespace mortise::analysis
