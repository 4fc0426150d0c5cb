// Vectors and sets over rows of the dual space, whole on rank 0.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/communicator.hpp"
#include "base/tpetra.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::feti {

/// What all ranks give, on rank 0 in the order of ranks; elsewhere nothing. Throws Error(machine) if memory runs out. Collective.
std::vector<double> on_root(std::vector<double> values, const Communicator& comm);

/// Rows that have numbers over all ranks. A value; the communicator outlives it.
class RowsOnRoot {
 public:
  /// number[i] of each owned row: over all ranks each from 0 on once, or -1 for rows that are left out.
  RowsOnRoot(std::vector<Global> number, const Communicator& comm) : number_(std::move(number)), comm_(comm) {}

  /// What a vector over the owned rows has at those with a number, by number, on rank 0. Collective.
  std::vector<double> to_root(const Eigen::Ref<const Eigen::VectorXd>& own) const;
  /// And back, `all` of rank 0; zero at the others. Collective.
  Eigen::VectorXd from_root(std::vector<double> all) const;
  /// What `map` makes on rank 0 of a vector over the numbers, back on the owned rows; zero at those without a number. Collective.
  Eigen::VectorXd map_on_root(const Eigen::Ref<const Eigen::VectorXd>& own,
                              const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map) const;
  /// The sets of all ranks as one, over the numbers; of use on rank 0. Collective.
  qp::FeasibleSet to_root(const qp::FeasibleSet& set) const;

 private:
  std::vector<Global> number_;
  const Communicator& comm_;
};

}  // namespace mortise::feti
