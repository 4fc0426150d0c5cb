// The dual operator F = B K^+ B', plus C = A^-1 on the rows of springs: one product solves once on every cluster, by factors as
// they are rounded, unless that is not enough.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/timer.hpp"
#include "base/tpetra.hpp"
#include "feti/clusters.hpp"
#include "feti/elastic_rows.hpp"
#include "feti/jump_operator.hpp"

namespace mortise::feti {

/// Refers to its parts; they outlive it.
class DualOperator : public Operator {
 public:
  /// `springs`: null if there are none.
  DualOperator(const JumpOperator& jump, const Clusters& clusters, Timers& timers, const ElasticRows* springs = nullptr)
      : jump_(jump), clusters_(clusters), timers_(timers), springs_(springs)
  {
  }
  Teuchos::RCP<const Map> getDomainMap() const override { return jump_.rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return jump_.rows(); }
  /// y = alpha F x + beta y, column by column. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;
  /// From now on with factors in double precision, or as if they were.
  void be_exact()
  {
    rounded_ = false;
    last_.reset();
  }
  bool rounded() const { return rounded_; }
  /// K^+ B'x of each subdomain of this rank if the last product was that with x, else null.
  const std::vector<Eigen::VectorXd>* response(const Vector& x) const
  {
    return last_ && last_->x == view(x) ? &last_->response : nullptr;
  }

 private:
  struct Product {
    Eigen::VectorXd x;
    std::vector<Eigen::VectorXd> response;
  };
  const JumpOperator& jump_;
  const Clusters& clusters_;
  Timers& timers_;
  const ElasticRows* springs_;
  bool rounded_ = true;
  mutable std::optional<Product> last_;
};

}  // namespace mortise::feti
