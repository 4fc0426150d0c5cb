// Contact as one dual problem leaves it, for another one of the same model: other components prescribed, or other subdomains.
#pragma once

#include <map>
#include <tuple>

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
  /// With those of all ranks. Collective.
  CarriedContact of_all_ranks(const Communicator& comm) const;

  /// Sets what is known of the contact rows of another problem on this rank; `forces`, `gaps`: of all its rows, see
  /// feti::DualProblem::forces() and gaps().
  void put(const feti::DualProblem& problem, Eigen::VectorXd& forces, Eigen::VectorXd& gaps) const;
  /// Multipliers and gradient of another problem that know of contact alone: good for the states of its constraints.
  qp::Solution states_for(const feti::DualProblem& problem) const;

 private:
  struct Values {
    double normal = 0;
    Point tangential = Point::Zero();
  };
  struct Node {
    Values force, gap;
  };
  CarriedContact() = default;

  std::map<NodeKey, Node> nodes_;
};

}  // namespace mortise::analysis
