#include "base/control_group.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace mortise {
namespace {

namespace fs = std::filesystem;

// A tree of groups as the kernel shows it.
class Groups {
 public:
  Groups()
  {
    std::string pattern = (fs::temp_directory_path() / "mortise_groups_XXXXXX").string();
    root_ = mkdtemp(pattern.data());
  }
  ~Groups() { fs::remove_all(root_); }
  void put(const std::string& file, const std::string& text) const
  {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  std::string path() const { return root_.string(); }

 private:
  fs::path root_;
};

TEST(ControlGroup, WithoutLimitThereIsNone)
{
  const Groups groups;
  groups.put("a/memory.max", "max\n");
  groups.put("a/memory.current", "100\n");
  groups.put("memory/b/memory.limit_in_bytes", "9223372036854771712\n");
  groups.put("memory/b/memory.usage_in_bytes", "100\n");
  EXPECT_TRUE(std::isinf(memory_left_by_groups("0::/a\n4:memory:/b\n", groups.path())));
  EXPECT_TRUE(std::isinf(memory_left_by_groups("0::/elsewhere\n", groups.path())));
  EXPECT_TRUE(std::isinf(memory_left_by_groups("", groups.path())));
}

// The group of a job may be limited, or the one above it; the cache of files is no memory that is taken.
TEST(ControlGroup, TheNarrowestGroupOnTheWayUpCounts)
{
  const Groups groups;
  groups.put("jobs/memory.max", "1000\n");
  groups.put("jobs/memory.current", "700\n");
  groups.put("jobs/memory.stat", "anon 300\nactive_file 150\ninactive_file 50\nslab 9\n");
  groups.put("jobs/seven/memory.max", "max\n");
  groups.put("jobs/seven/memory.current", "700\n");
  EXPECT_EQ(memory_left_by_groups("0::/jobs/seven\n", groups.path()), 1000 - 700 + 200);
  groups.put("jobs/seven/memory.max", "800\n");
  EXPECT_EQ(memory_left_by_groups("0::/jobs/seven\n", groups.path()), 800 - 700);
}

TEST(ControlGroup, TheFirstVersionToo)
{
  const Groups groups;
  groups.put("memory/docker/x/memory.limit_in_bytes", "5000\n");
  groups.put("memory/docker/x/memory.usage_in_bytes", "4000\n");
  groups.put("memory/docker/x/memory.stat", "active_file 1\ntotal_inactive_file 1000\ntotal_active_file 500\n");
  EXPECT_EQ(memory_left_by_groups("9:cpu,memory:/docker/x\n3:pids:/y\n", groups.path()), 2500);
  // Inside the container the group is the root of what is seen.
  groups.put("memory/memory.limit_in_bytes", "3000\n");
  groups.put("memory/memory.usage_in_bytes", "1000\n");
  EXPECT_EQ(memory_left_by_groups("4:memory:/not/seen\n", groups.path()), 2000);
}

}  // namespace
}  // namespace mortise
