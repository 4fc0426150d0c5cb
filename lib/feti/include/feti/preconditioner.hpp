// Preconditioners of the dual operator: approximations of its inverse that are sums over subdomains,
//
//     M = B D^-1 S D^-1 B',
//
// where D is the stiffness of the nodes (B is orthonormal in D^-1 but for contact rows that share nodes) and S acts on the
// surface of each subdomain: its block K_bb of the stiffness matrix (lumped) or the Schur complement K_bb - K_bi K_ii^-1 K_ib
// (Dirichlet) [Farhat and Roux, Int. J. Numer. Methods Eng. 32 (1991); Farhat, Mandel and Roux, Comput. Methods Appl. Mech. Eng.
// 115 (1994)].
#pragma once

#include <memory>
#include <vector>

#include "base/timer.hpp"
#include "feti/jump_operator.hpp"
#include "feti/subdomain_operator.hpp"

namespace mortise::feti {

/// Refers to `jump` and `subdomains`, which outlive it.
class Preconditioner : public Operator {
 public:
  enum class Kind { lumped, dirichlet };
  /// nodal_stiffness[s][n]: D. `factorization`: of K_ii, one of direct_solvers(). Throws as DirectSolver.
  Preconditioner(Kind kind, const partition::Decomposition& decomposition, const JumpOperator& jump, const Subdomains& subdomains,
                 const std::vector<std::vector<double>>& nodal_stiffness, const std::string& factorization, Timers& timers);
  Teuchos::RCP<const Map> getDomainMap() const override { return jump_.rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return jump_.rows(); }
  /// y = alpha M x + beta y. Rows that are neither gluing nor support nor contact keep their entry. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;

 private:
  struct Surface {
    std::vector<int> unknowns;
    Eigen::VectorXd weight;  // 1 / D
    SparseMatrix lower;      // K_bb
    SparseMatrix coupling;   // K_ib, for Dirichlet
    std::unique_ptr<DirectSolver> interior;
  };
  const JumpOperator& jump_;
  const Subdomains& subdomains_;
  struct Group {
    Surface surface;
    std::vector<std::size_t> members;  // the subdomains that are copies of one
  };
  std::vector<Group> groups_;
  Timers& timers_;
};

}  // namespace mortise::feti
