// The problem in displacements and multipliers on one rank: K and B of all subdomains as sparse matrices, less supports that hold
// one unknown each.
#pragma once

#include <memory>
#include <vector>

#include "base/cholesky.hpp"
#include "qp/sparse_newton.hpp"

namespace mortise::feti {

/// Over all rows of B and all unknowns, which are numbered as the matrices have them. Heavy: neither copies nor moves.
class WholeProblem {
 public:
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
  /// `stiffness`: K, lower triangle. `compliance`: how far each row gives way.
  WholeProblem(SparseMatrix stiffness, Rows rows, Eigen::VectorXd compliance, const qp::FeasibleSet& set);

  struct Solution {
    Eigen::VectorXd x, u;
    Eigen::VectorXd reaction;  ///< c - B u + S x, zero at rows without a constraint
    bool converged = false;    ///< exact to rounding; else the last guess
    int steps = 0;             ///< linear problems solved
    bool settled = true;       ///< if it converged: no state of a constraint rests on rounding
  };
  /// For the load f, the bounds c and the set; `near`: x of the last solution, to go on from. Throws as qp::SparseNewton.
  Solution solve(const Eigen::VectorXd& f, const Eigen::VectorXd& c, const qp::FeasibleSet& set,
                 const Eigen::VectorXd* near = nullptr);

  /// `regularised`: what K^+ is the inverse of, lower triangle. Throws as qp::SparseInverse.
  void make_inverse(SparseMatrix regularised);
  /// (B K^+ B' + S)^-1 r, once there is an inverse.
  Eigen::VectorXd inverse_times(const Eigen::VectorXd& r) const;

 private:
  // A row that holds one unknown.
  struct Support {
    Local row;
    int unknown;
    double coefficient;
  };

  void choose_supports(const qp::FeasibleSet& set);
  qp::SparseMatrices reduced(const SparseMatrix& stiffness) const;
  qp::FeasibleSet reduced(const qp::FeasibleSet& set) const;
  Eigen::VectorXd held(const Eigen::VectorXd& bounds) const;
  Eigen::VectorXd complete(const Eigen::VectorXd& kept, const Eigen::VectorXd& forces) const;

  SparseMatrix stiffness_;
  Rows rows_;
  Eigen::VectorXd compliance_;
  std::vector<Support> supports_;
  std::vector<int> free_;      // unknowns that no support holds
  std::vector<int> kept_;      // rows that are none of these,
  std::vector<Local> number_;  // and their numbers, -1 for others
  std::unique_ptr<qp::SparseNewton> newton_;
  Eigen::VectorXd last_, last_reaction_;        // displacements of the last solution, and the reaction of its kept rows
  SparseMatrix regularised_;                    // what K^+ is the inverse of,
  std::unique_ptr<qp::SparseInverse> inverse_;  // once F^-1 is asked for
};

}  // namespace mortise::feti
