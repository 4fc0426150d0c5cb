#include "feti/displacements.hpp"

#include <utility>

namespace mortise::feti {

std::vector<Eigen::VectorXd> Displacements::at(const Vector& lambda, const Eigen::VectorXd& nu)
{
  const auto values = view(lambda);
  if (problem_.communicator().any(!last_ || last_->lambda != values)) last_.emplace(Elastic{values, problem_.elastic(lambda)});
  return problem_.system().less_motion(last_->displacement, nu);
}

std::vector<Eigen::VectorXd> Displacements::at_product(const Vector& lambda, const Eigen::VectorXd& nu)
{
  const auto* response = product_.response(lambda);
  if (problem_.communicator().any(!response)) return at(lambda, nu);
  auto u = *response_;
  for (std::size_t s = 0; s < u.size(); ++s) u[s] -= (*response)[s];
  return problem_.system().less_motion(std::move(u), nu);
}

}  // namespace mortise::feti
