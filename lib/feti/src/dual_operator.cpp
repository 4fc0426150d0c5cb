#include "feti/dual_operator.hpp"

#include <utility>

namespace mortise::feti {

std::vector<Eigen::VectorXd> DualOperator::multiply(const Vector& x, Vector& y, Scalar alpha, Scalar beta) const
{
  const auto scope = timers_.scope("multiplication");
  auto forces = jump_.apply_transpose(x);
  clusters_.apply_inverse(forces, products_ == Products::rounded);
  Vector jumps = jump_.apply(forces);
  view(jumps) += jump_.compliance().cwiseProduct(view(x));
  if (springs_) springs_->add_compliance(1, x, jumps);
  y.update(alpha, jumps, beta);
  return forces;
}

void DualOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  for (std::size_t column = 0; column < x.getNumVectors(); ++column)
    multiply(*x.getVector(column), *y.getVectorNonConst(column), alpha, beta);
}

void RememberedProduct::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto factor = x.getVector(column);
    auto response = hessian_.multiply(*factor, *y.getVectorNonConst(column), alpha, beta);
    last_.emplace(Product{view(*factor), std::move(response)});
  }
}

}  // namespace mortise::feti
