// Supports in the dual problem as a matrix. A row that holds one unknown of one subdomain, with the coefficient beta, is
// eliminated before F is formed: with K the matrix whose inverse K^+ is, h the unknowns so prescribed, f the others and X =
// K_ff^-1,
//
//     W = F_cc - F_ch F_hh^-1 F_hc = B_cf X B_cf',   H = G_c - G_h F_hh^-1 F_hc = G_c - (B_c Y)',
//     C = G_h F_hh^-1 G_h' = R_h'(K Y)_h,            Y_h = R_h,  Y_f = -X K_fh R_h,
//
// over the rows c that are left: nothing grows with the number of rows h.
#pragma once

#include <span>
#include <vector>

#include "feti/direct_solver.hpp"
#include "feti/dual_system.hpp"

namespace mortise::feti {

/// A subdomain with some of its unknowns prescribed. Heavy: moves, does not copy.
class ConstrainedSubdomain {
 public:
  /// Factorizes K_ff, with an identity in place of K_hh, by the DirectSolver called `factorization`, unless `prescribed` is
  /// empty: then the subdomain's own factor serves, and it outlives this. `block`: unknowns a node. Throws as DirectSolver.
  ConstrainedSubdomain(const SubdomainOperator& subdomain, std::vector<Local> prescribed, int block,
                       const std::string& factorization);

  const std::vector<Local>& prescribed() const { return prescribed_; }
  /// columns[c], of all unknowns, <- X columns[c]_f, zero at prescribed ones.
  void apply_inverse(std::span<double* const> columns) const;
  /// u with u_h = `values` and (K u)_f = `forces`_f.
  Eigen::VectorXd displacement(const Eigen::VectorXd& values, Eigen::VectorXd forces) const;
  /// (K u)_h.
  Eigen::VectorXd reactions(const Eigen::VectorXd& u) const;

 private:
  const SubdomainOperator& subdomain_;
  std::vector<Local> prescribed_;
  SparseMatrix k_;
  std::optional<DirectSolver> solver_;  // none if nothing is prescribed
};

/// All rows that can be eliminated: supports along an axis, at unknowns that no other subdomain has, of nodes with no skew
/// support; none if there are no more than `few`. What is left is over the others.
class DirichletElimination {
 public:
  /// The system outlives it. Throws as ConstrainedSubdomain does. Collective.
  DirichletElimination(const DualSystem& system, Global few);

  /// Rows that are left, over all ranks, and their numbers: of each owned row, and of each row of jump().touched_rows(); -1 for
  /// an eliminated one.
  Global count() const { return count_; }
  const std::vector<Global>& number() const { return number_; }

  /// What a subdomain of this rank adds to W, H and C.
  struct Part {
    std::vector<Global> number;  ///< of its rows that are left
    Eigen::MatrixXd w;           ///< these x these
    int first = 0;               ///< of its kernel among all; nothing is eliminated if the following are empty
    Eigen::MatrixXd h;           ///< -(B_c Y)', dimension of the kernel x these
    Eigen::MatrixXd c;           ///< dimension of the kernel squared
  };
  Part part(std::size_t subdomain) const;

  /// d_c - F_ch F_hh^-1 d_h, in a vector over all rows; zero elsewhere. e -= G_h F_hh^-1 d_h, on every rank. Collective.
  Vector reduce(const Vector& d, Eigen::VectorXd& e) const;
  /// x_h = F_hh^-1 (d_h - G_h'nu - F_hc x_c), for the x_c that `x` holds. An empty nu is zero. Collective.
  void complete(const Vector& d, const Eigen::VectorXd& nu, Vector& x) const;

 private:
  struct PrescribedRow {
    Local row;  // of the overlapping map
    Local unknown;
    double coefficient;
  };
  static constexpr double other = 0, skew = 1, single = 2;  // kinds of rows
  Vector kinds_of_rows() const;
  std::vector<PrescribedRow> rows_to_eliminate(const JumpOperator::Block& block, const Vector& kinds) const;
  void choose(Global few);
  Eigen::VectorXd at_prescribed(std::size_t subdomain, const Eigen::Ref<const Eigen::VectorXd>& touched) const;

  const DualSystem& system_;
  std::vector<std::vector<PrescribedRow>> rows_;  // of each subdomain
  std::vector<ConstrainedSubdomain> subdomains_;
  Global count_ = 0;
  std::vector<Global> number_, touched_number_;
};

}  // namespace mortise::feti
