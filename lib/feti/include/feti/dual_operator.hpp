// The dual operator F = B K^+ B', plus C = A^-1 on the rows of springs: one product solves once on every cluster.
#pragma once

#include <optional>
#include <vector>

#include "base/timer.hpp"
#include "base/tpetra.hpp"
#include "feti/clusters.hpp"
#include "feti/elastic_rows.hpp"
#include "feti/jump_operator.hpp"
#include "qp/problem.hpp"

namespace mortise::feti {

/// By which factors products with F solve, where these are rounded to single precision (SubdomainOperator::rounding()).
enum class Products {
  rounded,  ///< as they are
  exact     ///< as if they were in double precision, at three times the price
};

/// Refers to its parts; they outlive it.
class DualOperator : public Operator {
 public:
  /// `springs`: null if there are none.
  DualOperator(const JumpOperator& jump, const Clusters& clusters, Timers& timers, const ElasticRows* springs, Products products)
      : jump_(jump), clusters_(clusters), timers_(timers), springs_(springs), products_(products)
  {
  }
  Teuchos::RCP<const Map> getDomainMap() const override { return jump_.rows(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return jump_.rows(); }
  /// y = alpha F x + beta y, column by column. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;
  /// The same of one column. Returns what it is made of: K^+ B'x of each subdomain of this rank. Collective.
  std::vector<Eigen::VectorXd> multiply(const Vector& x, Vector& y, Scalar alpha, Scalar beta) const;
  /// F x - d, d = B K^+ f - c: -B K^+ (f - B'x) + c at once. On slender subdomains K^+ f and K^+ B'x are large where each bends
  /// freely, and their difference, rounded in parts, is not known to what contact needs. Collective.
  void gradient(const Vector& x, const qp::RightHandSide& right, Vector& gradient) const;
  Products products() const { return products_; }

 private:
  void add_compliance(const Vector& x, Vector& y) const;

  const JumpOperator& jump_;
  const Clusters& clusters_;
  Timers& timers_;
  const ElasticRows* springs_;
  Products products_;
};

/// F for one solver, which asks what its last product was made of. Refers to F, which outlives it.
class RememberedProduct : public Operator {
 public:
  explicit RememberedProduct(const DualOperator& hessian) : hessian_(hessian) {}
  Teuchos::RCP<const Map> getDomainMap() const override { return hessian_.getDomainMap(); }
  Teuchos::RCP<const Map> getRangeMap() const override { return hessian_.getRangeMap(); }
  /// As that of F. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha, Scalar beta) const override;
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
  const DualOperator& hessian_;
  mutable std::optional<Product> last_;
};

}  // namespace mortise::feti
