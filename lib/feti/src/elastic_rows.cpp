#include "feti/elastic_rows.hpp"

#include "base/error.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

ElasticRows::ElasticRows(const constraint::Springs& springs, const JumpOperator& jump, const Communicator& comm)
    : comm_(comm), first_(jump.ranges().springs), own_(springs.own), stiffness_(springs.stiffness)
{
  const auto size = stiffness_.rows();
  scale_ = Eigen::VectorXd::Zero(size);
  for (std::size_t i = 0; i < own_.size(); ++i)
    scale_[static_cast<Eigen::Index>(own_[i])] = RowScaling::of(jump)[first_ + static_cast<Local>(i)];
  comm_.sum_in_place({scale_.data(), static_cast<std::size_t>(size)});
  weight_ = scale_.cwiseQuotient(stiffness_.diagonal());
  collectively(comm_, [&] {
    const SparseMatrix lower = stiffness_.triangularView<Eigen::Lower>();
    factor_.emplace(lower);
    if (!factor_->factorize(lower))
      throw Error(ExitStatus::bad_input, "the matrix of the springs is not positive definite; their stiffnesses differ too much");
  });
}

Eigen::VectorXd ElasticRows::gather(const Eigen::Ref<const Eigen::VectorXd>& own) const
{
  Eigen::VectorXd all = Eigen::VectorXd::Zero(scale_.size());
  for (std::size_t i = 0; i < own_.size(); ++i) all[static_cast<Eigen::Index>(own_[i])] = own[first_ + static_cast<Local>(i)];
  comm_.sum_in_place({all.data(), static_cast<std::size_t>(all.size())});
  return all;
}

void ElasticRows::add(double alpha, const Eigen::VectorXd& all, Vector& y) const
{
  auto own = view(y);
  for (std::size_t i = 0; i < own_.size(); ++i)
    own[first_ + static_cast<Local>(i)] += alpha * all[static_cast<Eigen::Index>(own_[i])];
}

void ElasticRows::add_compliance(double alpha, const Vector& x, Vector& y) const
{
  add(alpha, scale_.cwiseProduct(factor_->solve(Eigen::VectorXd(scale_.cwiseProduct(gather(view(x)))))), y);
}

void ElasticRows::add_stiffness(double alpha, const Vector& x, Vector& y) const
{
  add(alpha, weight_.cwiseProduct(stiffness_ * weight_.cwiseProduct(gather(view(x)))), y);
}

double ElasticRows::stored(const Vector& x) const
{
  const Eigen::VectorXd force = scale_.cwiseProduct(gather(view(x)));
  return force.dot(factor_->solve(force));
}

double ElasticRows::energy(const Vector& x) const
{
  const Eigen::VectorXd moved = weight_.cwiseProduct(gather(view(x)));
  return moved.dot(stiffness_ * moved);
}

Eigen::MatrixXd ElasticRows::compliance() const
{
  Eigen::MatrixXd all = scale_.asDiagonal().toDenseMatrix();
  for (Eigen::Index c = 0; c < all.cols(); ++c) all.col(c) = scale_.cwiseProduct(factor_->solve(Eigen::VectorXd(all.col(c))));
  return 0.5 * (all + all.transpose());
}

}  // namespace mortise::feti
