#include "feti/dual_operator.hpp"

namespace mortise::feti {

void DualOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  const auto scope = timers_.scope("multiplication");
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    auto forces = jump_.apply_transpose(*x.getVector(column));
    clusters_.apply_inverse(forces);
    y.getVectorNonConst(column)->update(alpha, jump_.apply(forces), beta);
  }
}

}  // namespace mortise::feti
