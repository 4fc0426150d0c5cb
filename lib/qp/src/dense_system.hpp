// The direct method's system as dense matrices: what is left when all other unknowns are eliminated.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "base/interruption.hpp"
#include "contact_system.hpp"
#include "move_problem.hpp"
#include "qp/condensed_newton.hpp"

namespace mortise::qp {

/// Cholesky factors, with as little added to the diagonal as rounding or dependent rows make necessary. Throws
/// Error(not_converged) if that is not enough, and as stop_if_requested: some thousand rows take a while.
Eigen::LLT<Eigen::MatrixXd> factorize(const Eigen::MatrixXd& a);

/// Whether a matrix has an inverse, of a reciprocal condition above `least`. Eigen's estimate of that is any number where a pivot
/// is exactly zero.
bool invertible(const Eigen::PartialPivLU<Eigen::MatrixXd>& factors, double least);

/// Has `work` take columns first to first + count of so many; between two pieces throws as stop_if_requested.
template <class Work>
void in_pieces(Eigen::Index columns, const Work& work)
{
  constexpr Eigen::Index piece = 256;
  for (Eigen::Index first = 0; first < columns; first += piece) {
    stop_if_requested();
    work(first, std::min(piece, columns - first));
  }
}

/// x = A^-1 b, in pieces.
Eigen::MatrixXd solve(const Eigen::LLT<Eigen::MatrixXd>& factor, Eigen::MatrixXd b);

/// Factors of one guess serve the next ones where there are many unknowns.
class DenseSystem : public ContactSystem {
 public:
  /// Both outlive it. `set`: over the unknowns of the matrices.
  DenseSystem(const CondensedMatrices& matrices, const Eigen::LLT<Eigen::MatrixXd>& factor_of_w, const FeasibleSet& set);

  Eigen::Index unknowns() const override { return matrices_.w.rows(); }
  Eigen::Index motions() const override { return matrices_.h.rows(); }
  const Eigen::VectorXd& own() const override { return matrices_.own; }
  double largest_ratio() const override { return matrices_.w.diagonal().cwiseQuotient(matrices_.own).maxCoeff(); }
  bool costly() const override { return false; }

  Eigen::VectorXd give(const Eigen::VectorXd& x) const override { return matrices_.w * x; }
  Eigen::VectorXd push(const Eigen::VectorXd& nu) const override { return matrices_.h.transpose() * nu; }
  Eigen::VectorXd excess(const Eigen::VectorXd& x, const Eigen::VectorXd& nu, const Eigen::VectorXd& e) const override
  {
    return matrices_.h * x - matrices_.c * nu - e;
  }
  Eigen::VectorXd lack(const Eigen::VectorXd& x, const Eigen::VectorXd& nu, const Eigen::VectorXd& e) const override
  {
    return e - matrices_.h * x + matrices_.c * nu;
  }
  Eigen::VectorXd size_of_give(const Eigen::VectorXd& x) const override { return matrices_.w.cwiseAbs() * x.cwiseAbs(); }
  double square_of_rounding(const Eigen::VectorXd&, const Eigen::VectorXd&) const override { return 0; }

  double square(const Eigen::VectorXd& l) const override { return l.dot(gram_.solve(l)); }
  void solve(const Guess& guess, const Eigen::VectorXd& b, const Eigen::VectorXd& e, Eigen::VectorXd& x,
             Eigen::VectorXd& nu) override;
  std::unique_ptr<PathFactor> factor(std::span<const Stiffening> entries, std::span<const Local> pinned,
                                     bool symmetric) const override;

 private:
  void solve_with_springs(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right, Eigen::VectorXd& nu) const;

  const CondensedMatrices& matrices_;
  const Eigen::LLT<Eigen::MatrixXd>& factor_of_w_;
  Eigen::VectorXd springs_;           // on motions
  Eigen::LLT<Eigen::MatrixXd> gram_;  // by which a lack of H x - C nu is measured
  std::optional<MoveFactor> factor_;  // of all that is closed, then of the last guess that took its own; none of few unknowns
};

}  // namespace mortise::qp
