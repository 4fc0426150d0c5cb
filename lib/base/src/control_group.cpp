#include "base/control_group.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace mortise {

namespace {

namespace fs = std::filesystem;

constexpr double unlimited = std::numeric_limits<double>::infinity();

// The names of the files of one version.
struct Names {
  const char *limit, *usage, *inactive, *active;
};
constexpr Names first_version{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file", "total_active_file"};
constexpr Names second_version{"memory.max", "memory.current", "inactive_file", "active_file"};

// The number in a file; infinite if there is no file, or no number ("max").
double number_in(const fs::path& path)
{
  std::ifstream file(path);
  double value = 0;
  return file >> value ? value : unlimited;
}

// The number after `key` in a file of lines "key number"; 0 if there is none.
double number_after(const std::string& key, const fs::path& path)
{
  std::ifstream file(path);
  std::string word;
  for (double value = 0; file >> word >> value;)
    if (word == key) return value;
  return 0;
}

double left_by(const fs::path& group, const Names& names)
{
  const double limit = number_in(group / names.limit), usage = number_in(group / names.usage);
  if (!(limit < 1e18) || !(usage < unlimited)) return unlimited;  // the first version writes "none" as a number near 2^63
  const auto cache = number_after(names.inactive, group / "memory.stat") + number_after(names.active, group / "memory.stat");
  return std::max(limit - usage + std::min(cache, usage), 0.0);
}

// Of the group at `path` below `root` and of those above it.
double least_from(const fs::path& root, fs::path path, const Names& names)
{
  double least = left_by(root, names);
  for (path = path.relative_path(); !path.empty(); path = path.parent_path())
    least = std::min(least, left_by(root / path, names));
  return least;
}

}  // namespace

double memory_left_by_groups(const std::string& membership, const std::string& mount)
{
  double least = unlimited;
  std::istringstream lines(membership);
  for (std::string line; std::getline(lines, line);) {  // number:controllers:path
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    if (controllers.empty())
      for (const char* root : {"", "unified"}) least = std::min(least, least_from(fs::path(mount) / root, path, second_version));
    std::istringstream names(controllers);
    bool memory = false;
    for (std::string name; std::getline(names, name, ',');) memory = memory || name == "memory";
    if (memory) least = std::min(least, least_from(fs::path(mount) / "memory", path, first_version));
  }
  return least;
}

}  // namespace mortise
