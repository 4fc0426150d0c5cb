#include "io/files.hpp"

#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;

TEST(Files, DirectoryIsMadeWithTheOnesAbove)
{
  const Communicator comm;
  const Scratch scratch(comm);
  prepare_directory(scratch / "a/b/c", comm);
  EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/b/c"));
  EXPECT_TRUE(std::filesystem::is_empty(scratch / "a/b/c"));
}

// Files of an earlier run on seven ranks would be opened together with ours; notes of the user stay.
TEST(Files, WhatAnEarlierRunLeftIsRemovedAndNothingElse)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const std::set<std::string> theirs{"notes.txt", "solution_final.vtu", "my_solution.pvd", "summary.json.bak"};
  if (comm.root()) {
    for (const char* name : {"solution.pvd", "solution.pvtu", "solution_0.vtu", "solution_6.vtu", "contact.pvd", "contact_6.vtu",
                             "results.h5", "history.csv", "deck.yaml", "summary.json", "results.h5.part"})
      std::ofstream(scratch / name) << "old";
    for (const auto& name : theirs) std::ofstream(scratch / name) << "mine";
  }
  prepare_directory(scratch.path(), comm);
  EXPECT_EQ(scratch.files(), theirs);
}

TEST(Files, DirectoryThatCannotBeMadeIsAnErrorOnAllRanks)
{
  const Communicator comm;
  const Scratch scratch(comm);
  if (comm.root()) std::ofstream(scratch / "file") << "x";
  for (const std::string below : {"file/out", "file"}) {
    const auto message = message_of_machine_error([&] { prepare_directory(scratch / below, comm); });
    EXPECT_NE(message.find("output directory " + scratch / below), std::string::npos) << message;
  }
}

TEST(Files, DirectoryWhereNothingCanBeWrittenIsFoundOutAtOnce)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const auto message = message_of_machine_error([&] {
    const FullDisk full(0);
    prepare_directory(scratch.path(), comm);
  });
  EXPECT_NE(message.find(scratch.path()), std::string::npos) << message;
  EXPECT_EQ(scratch.files(), std::set<std::string>{});
}

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

}  // namespace
}  // namespace mortise::io
