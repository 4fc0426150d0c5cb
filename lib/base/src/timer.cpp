#include "base/timer.hpp"

#include <sys/resource.h>

namespace mortise {

double Timers::seconds(const std::string& stage) const
{
  const auto found = seconds_.find(stage);
  return found == seconds_.end() ? 0.0 : found->second;
}

std::vector<Timers::Spread> Timers::spread(const Communicator& comm) const
{
  std::vector<Spread> result;
  for (const auto& [stage, seconds] : seconds_)
    result.push_back({stage, comm.min(seconds), comm.sum(seconds) / comm.size(), comm.max(seconds)});
  return result;
}

long long peak_memory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024LL;  // Linux counts in KiB
}

}  // namespace mortise
