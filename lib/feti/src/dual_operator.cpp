#include "feti/dual_operator.hpp"

#include <utility>

namespace mortise::feti {

void DualOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  const auto scope = timers_.scope("multiplication");
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    auto forces = jump_.apply_transpose(*x.getVector(column));
    clusters_.apply_inverse(forces, rounded_);
    Vector jumps = jump_.apply(forces);
    view(jumps) += jump_.compliance().cwiseProduct(view(*x.getVector(column)));
    if (springs_) springs_->add_compliance(1, *x.getVector(column), jumps);
    y.getVectorNonConst(column)->update(alpha, jumps, beta);
    last_.emplace(Product{view(*x.getVector(column)), std::move(forces)});
  }
}

}  // namespace mortise::feti
