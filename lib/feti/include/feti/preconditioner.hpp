// Preconditioners of the dual operator: approximations of its inverse that are sums over subdomains,
//
//     M = C (B D^-1 S D^-1 B' + E) C,   C = (B D^-1 B' + E)^-1,
//
// - E: what rows give way by (DualProblem::given_way()).
// - D: the stiffness of the nodes, so that M F is near the identity [Klawonn and Widlund, Comm. Pure Appl. Math. 54 (2001)].
// - C: the identity but for contact rows that share nodes, since B is orthonormal in D^-1 elsewhere; of these rows only those
//   count that are free on the active set at hand.
// - S acts on the nodes of each subdomain that rows of B touch: their block K_bb of the stiffness matrix (lumped) [Farhat and
//   Roux, Int. J. Numer. Methods Eng. 32 (1991)], or the Schur complement K_bb - K_bi K_ii^-1 K_ib (Dirichlet) [Farhat, Mandel
//   and Roux, Comput. Methods Appl. Mech. Eng. 115 (1994)]. There free surfaces move like the inside: with K_bb thin parts would
//   seem too stiff.
#pragma once

#include <memory>
#include <vector>

#include "base/timer.hpp"
#include "feti/elastic_rows.hpp"
#include "feti/jump_operator.hpp"
#include "feti/subdomain_operator.hpp"
#include "qp/problem.hpp"

namespace mortise::feti {

class ContactGram;

/// Refers to `jump`, `subdomains` and `nodal_stiffness`, which outlive it.
class Preconditioner : public qp::ActiveSetPreconditioner {
 public:
  enum class Kind { lumped, dirichlet };
  /// nodal_stiffness[s][n]: D. `discs`: in which contact rows of this rank slip. `factorization`: of K_ii, by a solver of
  /// DirectSolver's. `springs`: null if there are none. Throws as DirectSolver. Collective.
  Preconditioner(Kind kind, const partition::Decomposition& decomposition, const JumpOperator& jump, const Subdomains& subdomains,
                 const std::vector<std::vector<double>>& nodal_stiffness, std::span<const qp::Disc> discs,
                 const std::string& factorization, Timers& timers, const Communicator& comm,
                 const ElasticRows* springs = nullptr);
  ~Preconditioner() override;

  /// As ActiveSetPreconditioner has it: the inverse of B D^-1 B' is that of the contact rows that stay free, of `slips` that of
  /// T'(B D^-1 B') T + Sigma, T the tangents and Sigma their curvatures. Collective.
  void fix(std::span<const Local> fixed, std::span<const qp::SlipDirection> slips) override;
  bool knows_curvature() const override { return contact_ == with_slip_.get(); }
  /// Twice the strain energy of displacements that close the gaps r: those of D^-1 B' C r at the interfaces, and inside what is
  /// nearly of least energy. Collective.
  double energy(const Vector& r) override;
  Teuchos::RCP<const Map> getDomainMap() const override { return jump_.rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return jump_.rows(); }
  /// y = alpha M x + beta y. Rows that are neither gluing nor support nor contact keep their entry. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;

 private:
  struct Surface {
    std::vector<int> unknowns;
    Eigen::VectorXd weight;                               // 1 / D
    std::unique_ptr<const InterfaceStiffness> stiffness;  // S
  };
  const JumpOperator& jump_;
  const std::vector<std::vector<double>>& nodal_stiffness_;
  int dimension_;
  const Subdomains& subdomains_;
  struct Group {
    Surface surface;
    std::vector<std::size_t> members;  // copies of one subdomain, and alike in which nodes are touched
  };
  std::vector<Group> groups_;
  std::vector<qp::Disc> discs_;
  std::unique_ptr<ContactGram> gram_, with_slip_;  // B D^-1 B' of the contact rows; the other once it is asked for
  ContactGram* contact_ = nullptr;                 // that of the two which fix() wants
  const ElasticRows* springs_;                     // null if there are none
  const Communicator& comm_;
  Timers& timers_;
};

}  // namespace mortise::feti
