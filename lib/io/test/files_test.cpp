#include "io/files.hpp"

#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;

TEST(Files, TextAppearsWholeOrNotAtAll)
{
  const Communicator comm;
  const Scratch scratch(comm);
  if (!comm.root()) return;
  const std::string path = scratch / "text";
  write_text(path, "first");
  message_of_machine_error([&] {
    const FullDisk full(1000);
    write_text(path, std::string(100000, 'x'));
  });
  EXPECT_EQ(content(path), "first");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  write_text(path, "second");
  EXPECT_EQ(content(path), "second");
}

// What a link at the name, or at the temporary one, points to stays as it is.
TEST(Files, NothingIsWrittenThroughLinks)
{
  const Communicator comm;
  const Scratch scratch(comm);
  if (!comm.root()) return;
  for (const char* name : {"text", "text.part"}) {
    write_text(scratch / "mine", "mine");
    std::filesystem::remove(scratch / "text");
    std::filesystem::create_symlink(scratch / "mine", scratch / name);
    write_text(scratch / "text", "result");
    EXPECT_EQ(content(scratch / "mine"), "mine") << name;
    EXPECT_EQ(content(scratch / "text"), "result");
    EXPECT_FALSE(std::filesystem::is_symlink(scratch / "text"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "text.part"));
  }
}

}  // namespace
}  // namespace mortise::io
