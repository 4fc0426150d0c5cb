#include "base/timer.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>

#include "base/control_group.hpp"

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

// The number after `key` in a file of lines "key number"; infinite if there is none.
double kilobytes_in(const char* path, const std::string& key)
{
  std::ifstream file(path);
  std::string word;
  double value = 0;
  while (file >> word)
    if (word == key) return file >> value ? value : std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::infinity();
}

std::string text_of(const char* path)
{
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// What a limit of this process leaves it, if the kernel counts what it holds under `key`.
double left_of(int resource, const std::string& key)
{
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur) - 1024 * kilobytes_in("/proc/self/status", key);
}

}  // namespace

double available_memory()
{
  double result = 1024 * kilobytes_in("/proc/meminfo", "MemAvailable:");
  result = std::min(result, memory_left_by_groups(text_of("/proc/self/cgroup"), "/sys/fs/cgroup"));
  result = std::min({result, left_of(RLIMIT_AS, "VmSize:"), left_of(RLIMIT_DATA, "VmData:")});
  return std::max(result, 0.0);
}

}  // namespace mortise
