#include "qp/slip_law.hpp"

#include <cmath>
#include <utility>

namespace mortise::qp {

std::vector<double> half_way_back(std::vector<double> radii, std::span<const double> before)
{
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = std::isinf(before[i]) ? 2 * radii[i] : 0.5 * (radii[i] + before[i]);
  return radii;
}

FollowedRadii::FollowedRadii(const SlipLaw& law, FeasibleSet& set, const Communicator& comm)
    : law_(law), set_(set), comm_(comm), now_(set.radii()), before_(now_)
{
}

double FollowedRadii::update(const Vector& x, bool apply)
{
  auto wanted = law_.radii(&x);
  double square = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] != now_[i]) square += (wanted[i] - now_[i]) * (wanted[i] - now_[i]);  // infinite while a point sticks anyway
  if (apply) {
    before_ = std::exchange(now_, std::move(wanted));
    set_.set_radii(now_);
  }
  return std::sqrt(comm_.sum(square));
}

void FollowedRadii::retreat()
{
  now_ = half_way_back(std::move(now_), before_);
  set_.set_radii(now_);
}

}  // namespace mortise::qp
