// A small symmetric matrix as a distributed operator: every rank holds it whole and applies its own rows.
#pragma once

#include "base/cholesky.hpp"
#include "base/tpetra.hpp"

namespace mortise::qp {

class DenseOperator : public Operator {
 public:
  DenseOperator(Eigen::MatrixXd a, Teuchos::RCP<const Map> map, const Communicator& comm)
      : a_(std::move(a)), map_(map), comm_(comm)
  {
  }
  Teuchos::RCP<const Map> getDomainMap() const override { return map_; }
  Teuchos::RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const override
  {
    Eigen::VectorXd whole = Eigen::VectorXd::Zero(a_.rows());
    const auto in = x.getData(0);
    for (Local i = 0; i < in.size(); ++i) whole[map_->getGlobalElement(i)] = in[i];
    comm_.sum_in_place({whole.data(), static_cast<std::size_t>(whole.size())});
    const Eigen::VectorXd product = a_ * whole;
    const auto out = y.getDataNonConst(0);
    for (Local i = 0; i < out.size(); ++i) out[i] = beta * out[i] + alpha * product[map_->getGlobalElement(i)];
  }

 private:
  Eigen::MatrixXd a_;
  Teuchos::RCP<const Map> map_;
  Communicator comm_;
};

/// Unknowns 0 .. n-1 in equal parts.
inline Teuchos::RCP<const Map> even_map(Global n, const Communicator& comm)
{
  return Teuchos::rcp(new Map(n, 0, teuchos(comm)));
}

/// The entries of this rank.
inline Vector local_part(const Eigen::VectorXd& whole, Teuchos::RCP<const Map> map)
{
  Vector x(map);
  auto values = view(x);
  for (Local i = 0; i < values.size(); ++i) values[i] = whole[map->getGlobalElement(i)];
  return x;
}

inline Eigen::VectorXd gathered(const Vector& x, const Communicator& comm)
{
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(x.getGlobalLength()));
  const auto values = view(x);
  for (Local i = 0; i < values.size(); ++i) whole[x.getMap()->getGlobalElement(i)] = values[i];
  comm.sum_in_place({whole.data(), static_cast<std::size_t>(whole.size())});
  return whole;
}

/// The columns of a dense G that this rank holds.
inline SparseMatrix local_columns(const Eigen::MatrixXd& g, const Map& map)
{
  const auto columns = static_cast<Eigen::Index>(map.getNodeNumElements());
  Eigen::MatrixXd part(g.rows(), columns);
  for (Local i = 0; i < columns; ++i) part.col(i) = g.col(map.getGlobalElement(i));
  return part.sparseView();
}

}  // namespace mortise::qp
