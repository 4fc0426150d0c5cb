#include "contact_system.hpp"

#include <algorithm>
#include <utility>

namespace mortise::qp {

Eigen::VectorXd shared_by_discs(Eigen::VectorXd own, const FeasibleSet& set)
{
  for (const auto& disc : set.discs())
    if (disc.size() == 2) own[disc.index[0]] = own[disc.index[1]] = std::max(own[disc.index[0]], own[disc.index[1]]);
  return own;
}

std::vector<Move> moves_of_closed(const FeasibleSet& set)
{
  std::vector<Move> result;
  const auto add = [&](Local unknown) { result.push_back({{unknown, -1, -1}, {1, 0, 0}, {1, 0, 0}, 0}); };
  for (const auto& bound : set.bounds()) add(bound.index);
  for (const auto& disc : set.discs())
    for (int k = 0; k < disc.size(); ++k) add(disc.index[static_cast<std::size_t>(k)]);
  return result;
}

}  // namespace mortise::qp
