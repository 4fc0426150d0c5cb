// Products that are off by so much of their size, each time otherwise, while they are not exact: what a solver that compares them
// with each other makes no more progress by.
#pragma once

#include <random>

#include "base/tpetra.hpp"

namespace mortise {

class RoughOperator : public Operator {
 public:
  /// `a` outlives it.
  RoughOperator(const Operator& a, double off) : a_(a), off_(off) {}
  Teuchos::RCP<const Map> getDomainMap() const override { return a_.getDomainMap(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return a_.getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override
  {
    a_.apply(x, y, mode, alpha, beta);
    if (exact) return;
    MultiVector noise(y.getMap(), 1);
    auto values = view(*noise.getVectorNonConst(0));
    for (auto& value : values) value = normal_(random_);
    y.update(off_ * y.getVector(0)->norm2() / noise.getVector(0)->norm2(), noise, 1);
  }
  bool exact = false;

 private:
  const Operator& a_;
  double off_;
  mutable std::mt19937 random_{11};
  mutable std::normal_distribution<double> normal_;
};

}  // namespace mortise
