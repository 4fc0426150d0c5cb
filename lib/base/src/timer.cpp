#include "base/timer.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace mortise {

double Timers::seconds(const std::string& stage) const
{
  const auto found = stages_.find(stage);
  return found == stages_.end() ? 0.0 : found->second.seconds;
}

Traffic Timers::traffic(const std::string& stage) const
{
  const auto found = stages_.find(stage);
  return found == stages_.end() ? Traffic{} : found->second.traffic;
}

std::vector<Timers::Spread> Timers::spread(const Communicator& comm) const
{
  std::vector<Spread> result;
  for (const auto& [name, stage] : stages_)
    result.push_back({name, comm.min(stage.seconds), comm.sum(stage.seconds) / comm.size(), comm.max(stage.seconds)});
  return result;
}

long long peak_memory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024LL;  // Linux counts in KiB
}

namespace {

// The number after `key` in a file of lines "key number", or the file's first number for an empty key; infinite if there is none.
double number_in(const char* path, const std::string& key)
{
  std::ifstream file(path);
  std::string word;
  double value = 0;
  while (key.empty() || file >> word)
    if (key.empty() || word == key) return file >> value ? value : std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double available_memory()
{
  double result = 1024 * number_in("/proc/meminfo", "MemAvailable:");
  const double group = number_in("/sys/fs/cgroup/memory.max", "");
  if (std::isfinite(group)) result = std::min(result, group - number_in("/sys/fs/cgroup/memory.current", ""));
  rlimit address_space{};
  if (getrlimit(RLIMIT_AS, &address_space) == 0 && address_space.rlim_cur != RLIM_INFINITY)
    result = std::min(result, static_cast<double>(address_space.rlim_cur) - 1024 * number_in("/proc/self/status", "VmSize:"));
  return std::max(result, 0.0);
}

}  // namespace mortise
