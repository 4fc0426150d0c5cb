#include "qp/projection.hpp"

#include <Eigen/SparseCore>
#include <cmath>

namespace mortise::qp {

namespace {

// The dual function and its gradient at one nu.
struct Evaluation {
  Vector shifted;  // w = y - G' nu
  Vector point;    // P_Omega(w)
  double value = 0;
  Eigen::VectorXd gradient;
};

Evaluation evaluate(const Vector& y, const Eigen::VectorXd& nu, const EqualityConstraint& equality, const FeasibleSet& set)
{
  Evaluation result{Vector(y, Teuchos::Copy), Vector(y.getMap()), 0, {}};
  equality.add_transpose(-1, nu, result.shifted);
  result.point.assign(result.shifted);
  set.project(view(result.point));
  const auto w = view(std::as_const(result.shifted));
  const auto x = view(std::as_const(result.point));
  result.value = equality.communicator().sum(x.dot(w) - 0.5 * x.squaredNorm()) + equality.right_side().dot(nu);
  result.gradient = equality.right_side() - equality.apply(result.point);
  return result;
}

// Sum of c c' over `columns` of G, each with a factor, into `triplets` (lower triangle).
void add_outer(const SparseMatrix& g, int a, int b, double factor, std::vector<Eigen::Triplet<double>>& triplets)
{
  for (SparseMatrix::InnerIterator i(g, a); i; ++i)
    for (SparseMatrix::InnerIterator j(g, b); j; ++j)
      if (i.row() >= j.row())
        triplets.emplace_back(static_cast<int>(i.row()), static_cast<int>(j.row()), factor * i.value() * j.value());
}

// G (I - D) G' with the derivative D of P_Omega at w: this is what the active constraints take away from G G'.
SparseMatrix lost(const EqualityConstraint& equality, const FeasibleSet& set, const Vector& shifted)
{
  const SparseMatrix& g = equality.local();
  const auto w = view(shifted);
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& bound : set.bounds())
    if (w[bound.index] <= bound.lower) add_outer(g, bound.index, bound.index, 1, triplets);
  for (const auto& disc : set.discs()) {
    const Eigen::Vector2d y = from_centre(disc, w);
    const double distance = y.norm();
    if (distance <= disc.radius) continue;
    const Eigen::Vector2d n = y / distance;
    const double ratio = disc.radius / distance;  // D = ratio (I - n n')
    for (int a = 0; a < disc.size(); ++a)
      for (int b = 0; b < disc.size(); ++b) {
        const double d = disc.size() == 1 ? 0.0 : ratio * ((a == b ? 1.0 : 0.0) - n[a] * n[b]);
        add_outer(g, disc.index[a], disc.index[b], (a == b ? 1.0 : 0.0) - d, triplets);
      }
  }
  SparseMatrix local(equality.size(), equality.size());
  local.setFromTriplets(triplets.begin(), triplets.end());
  return sum_over_ranks(local, equality.communicator());
}

}  // namespace

Projection project(const Vector& y, const EqualityConstraint& equality, const FeasibleSet& set)
{
  Eigen::VectorXd nu = Eigen::VectorXd::Zero(equality.size());
  Evaluation now = evaluate(y, nu, equality, set);
  if (equality.size() == 0) return {now.point, nu, true, 0};

  const double scale = equality.norm(equality.right_side()) + y.norm2() + 1e-300;
  const SparseMatrix& gram = equality.gram();
  const Eigen::VectorXd diagonal = gram.diagonal();
  Cholesky factor(gram);
  double residual = equality.norm(now.gradient) / scale;
  double regularisation = 1e-1;
  for (int step = 0; step < 100 && residual > 1e-13; ++step) {
    SparseMatrix jacobian = gram - lost(equality, set, now.shifted);
    const double delta = std::max(regularisation * std::min(residual, 1.0), 1e-14);
    for (int i = 0; i < jacobian.cols(); ++i) jacobian.coeffRef(i, i) += delta * diagonal[i];
    if (!factor.factorize(jacobian)) {
      regularisation *= 10;
      continue;
    }
    const Eigen::VectorXd direction = -factor.solve(now.gradient);
    const double slope = now.gradient.dot(direction);
    bool accepted = false;
    for (double t = 1; t > 1e-6 && !accepted; t *= 0.5) {
      const Eigen::VectorXd trial = nu + t * direction;
      Evaluation next = evaluate(y, trial, equality, set);
      const double next_residual = equality.norm(next.gradient) / scale;
      accepted = next.value <= now.value + 1e-4 * t * slope || next_residual <= 0.5 * residual;
      if (!accepted) continue;
      // A residual that does not fall while full steps are taken wants larger steps.
      if (t == 1) regularisation *= next_residual > 0.5 * residual ? 0.1 : 1.0;
      nu = trial;
      now = std::move(next);
      residual = next_residual;
    }
    if (!accepted) break;
  }
  return {now.point, nu, residual <= 1e-9, residual};
}

}  // namespace mortise::qp
