#include "feti/state_record.hpp"

#include <utility>

namespace mortise::feti {

long long StateRecord::note(std::vector<ContactStatus> states)
{
  if (!steps_.empty() && steps_.back().size() != states.size()) steps_.clear();
  long long changes = 0;
  if (!steps_.empty())
    for (std::size_t i = 0; i < states.size(); ++i) changes += states[i] != steps_.back()[i];
  steps_.push_back(std::move(states));
  if (steps_.size() > kept + 1) steps_.pop_front();
  return changes;
}

std::vector<StateRecord::Changes> StateRecord::changes() const
{
  std::vector<Changes> result(steps_.empty() ? 0 : steps_.back().size());
  for (std::size_t s = 1; s < steps_.size(); ++s)
    for (std::size_t i = 0; i < result.size(); ++i) {
      const auto before = steps_[s - 1][i], now = steps_[s][i];
      if (before == now) continue;
      (before == ContactStatus::open || now == ContactStatus::open ? result[i].contact : result[i].friction) += 1;
    }
  return result;
}

}  // namespace mortise::feti
