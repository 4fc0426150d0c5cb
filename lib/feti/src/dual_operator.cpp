#include "feti/dual_operator.hpp"

#include <utility>

#include "row_scaling.hpp"

namespace mortise::feti {

std::vector<Eigen::VectorXd> DualOperator::multiply(const Vector& x, Vector& y, Scalar alpha, Scalar beta) const
{
  const auto scope = timers_.scope("multiplication");
  auto forces = jump_.apply_transpose(x);
  clusters_.apply_inverse(forces, products_ == Products::rounded);
  Vector jumps = jump_.apply(forces);
  add_compliance(x, jumps);
  y.update(alpha, jumps, beta);
  return forces;
}

// y += S x, what rows and springs give way by themselves.
void DualOperator::add_compliance(const Vector& x, Vector& y) const
{
  view(y) += RowScaling::compliance_of(jump_).cwiseProduct(view(x));
  if (springs_) springs_->add_compliance(1, x, y);
}

void DualOperator::gradient(const Vector& x, const qp::RightHandSide& right, Vector& gradient) const
{
  const auto scope = timers_.scope("multiplication");
  auto forces = jump_.apply_transpose(x);
  for (std::size_t s = 0; s < forces.size(); ++s) forces[s] -= right.f[s];
  clusters_.apply_inverse(forces, products_ == Products::rounded);
  gradient.assign(jump_.apply(forces));
  view(gradient) += right.c;
  add_compliance(x, gradient);
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
