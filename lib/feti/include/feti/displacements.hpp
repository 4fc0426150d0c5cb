// Displacements of a load state on the way to its solution: errors, norms and how far displacements fit ask for them in turn.
#pragma once

#include <optional>
#include <vector>

#include "feti/dual_problem.hpp"

namespace mortise::feti {

/// Of one problem: u = K^+ (f - B'lambda) - R nu of each subdomain of this rank, lengths. Keeps what the next question may want
/// again.
class Displacements {
 public:
  /// `product`: F as the solver of the problem has it. Both outlive this.
  Displacements(const DualProblem& problem, const RememberedProduct& product)
      : problem_(problem), product_(product), response_(problem.response())
  {
  }
  /// DualProblem::displacement(), which solves on every subdomain if lambda is another one than the last time. Collective.
  std::vector<Eigen::VectorXd> at(const Vector& lambda, const Eigen::VectorXd& nu);
  /// The same without a solution of every subdomain if the last product was that with lambda: a difference of what loads and
  /// multipliers do alone, which loses figures where these are large beside it, as on thin plates. Collective.
  std::vector<Eigen::VectorXd> at_product(const Vector& lambda, const Eigen::VectorXd& nu);

 private:
  struct Elastic {
    Eigen::VectorXd lambda;
    std::vector<Eigen::VectorXd> displacement;
  };
  const DualProblem& problem_;
  const RememberedProduct& product_;
  const SharedField response_;
  std::optional<Elastic> last_;
};

}  // namespace mortise::feti
