// The problem in displacements and multipliers on one rank: K and B of all subdomains as sparse matrices, less supports that hold
// one unknown each.
#pragma once

#include <vector>

#include "base/cholesky.hpp"
#include "base/extended.hpp"
#include "qp/sparse_newton.hpp"

namespace mortise::feti {

/// The rows of B that hold one unknown and have no constraint, an unknown once: they and their unknowns are eliminated.
class SupportElimination {
 public:
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
  /// `rows`: B. `compliance`: how far each row gives way. `set` is over the rows.
  SupportElimination(Rows rows, Eigen::VectorXd compliance, const qp::FeasibleSet& set);

  const Rows& rows() const { return rows_; }                                        ///< all of them
  const std::vector<int>& free() const { return free_; }                            ///< unknowns that no support holds
  const std::vector<int>& kept() const { return kept_; }                            ///< rows that are none of these supports
  Local number(Local row) const { return number_[static_cast<std::size_t>(row)]; }  ///< in kept(); -1 for others

  /// K, given by its lower triangle, and B over free() and kept().
  qp::SparseMatrices reduced(const SparseMatrix& stiffness) const;
  qp::FeasibleSet reduced(const qp::FeasibleSet& set) const;
  /// The unknowns that supports hold, over all unknowns, where their rows are to see these bounds.
  Eigen::VectorXd prescribed(const Eigen::VectorXd& bounds) const;
  /// The multipliers of all rows from those of kept(), where supports take up what `forces` lack.
  Eigen::VectorXd complete(const Eigen::VectorXd& multipliers, ExtendedVector forces) const;

 private:
  // A row that holds one unknown.
  struct Support {
    Local row;
    int unknown;
    double coefficient;
  };
  Rows rows_;
  Eigen::VectorXd compliance_;
  std::vector<Support> supports_;
  std::vector<int> free_, kept_;
  std::vector<Local> number_;
};

/// Gauges of motions v that nothing resists, K v = 0 and B v = 0 but for the gauges m themselves. A row over a whole body would
/// make the matrices full. What it prevents, holding one unknown prevents as well, at first; then u is moved along v to where the
/// gauge wants it. Forces of gauges are rounding.
class Gauges {
 public:
  using Motions = Eigen::SparseMatrix<double>;
  /// `motions`: v of the last so many of `rows` (B), as columns over all unknowns. These rows are replaced by ones with a single
  /// entry that do the same work on v: the unknowns are found by elimination, so that they are as independent as the motions.
  Gauges(SupportElimination::Rows& rows, Motions motions);
  /// Of a solution with the other rows: x and u of the gauges, whose bounds stand in c.
  void restore(const Eigen::VectorXd& c, Eigen::VectorXd& x, Eigen::VectorXd& u) const;

 private:
  Motions motions_;
  SupportElimination::Rows gauges_;     // m, as rows
  Eigen::MatrixXd work_, pinned_work_;  // of each gauge on each motion, and of what replaces it
};

/// Over all rows of B and all unknowns, which are numbered as the matrices have them. Heavy: neither copies nor moves.
class WholeProblem {
 public:
  /// `stiffness`: K, lower triangle; `elimination` of the same unknowns outlives it. `patient`: as of qp::SparseNewton.
  WholeProblem(SparseMatrix stiffness, const SupportElimination& elimination, bool patient);

  struct Solution {
    Eigen::VectorXd x, u;
    Eigen::VectorXd reaction;  ///< c - B u + S x, zero at rows without a constraint
    bool converged = false;    ///< exact to rounding; else the last guess
    int steps = 0;             ///< linear problems solved
    bool settled = true;       ///< if it converged: no state of a constraint rests on rounding
  };
  /// A solution of a problem before, or a guess at one of this.
  struct Start {
    Eigen::VectorXd x, reaction;
    bool solved;
  };
  /// For the load f, the bounds c and the set; `near`: to go on from, where of a solution x alone counts if this found it.
  /// Throws as qp::SparseNewton.
  Solution solve(const Eigen::VectorXd& f, const Eigen::VectorXd& c, const qp::FeasibleSet& set, const Start* near = nullptr);

 private:
  SparseMatrix stiffness_;
  const SupportElimination& elimination_;
  qp::SparseNewton newton_;
  Eigen::VectorXd last_, last_reaction_;  // displacements of the last solution, and the reaction of its kept rows
};

/// (B K^+ B' + S)^-1. Heavy: moves, does not copy.
class WholeInverse {
 public:
  /// `regularised`: what K^+ is the inverse of, lower triangle; `elimination` of the same unknowns outlives it. `slender`: with
  /// factors that keep what is soft. Throws as qp::SparseInverse.
  WholeInverse(SparseMatrix regularised, const SupportElimination& elimination, bool slender);
  /// Times r.
  Eigen::VectorXd times(const Eigen::VectorXd& r) const;

 private:
  SparseMatrix regularised_;
  const SupportElimination& elimination_;
  qp::SparseInverse inverse_;
};

}  // namespace mortise::feti
