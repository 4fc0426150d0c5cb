// The memory that control groups of Linux leave to a process: containers, batch systems and systemd limit it so.
#pragma once

#include <string>

namespace mortise {

/// Bytes that the groups of a process, and the ones above them, have left; infinite if none is limited. The cache of files, which
/// gives way, counts as free. `membership`: the text of /proc/self/cgroup; `mount`: where the groups are seen, /sys/fs/cgroup.
/// Knows versions 1 and 2. Inside a container a path may not be seen whole: the part that is there counts.
double memory_left_by_groups(const std::string& membership, const std::string& mount);

}  // namespace mortise
