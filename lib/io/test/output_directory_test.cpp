#include "io/output_directory.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/files.hpp"
#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;

using Names = std::set<std::string>;

// Of the files that a run reads.
const std::vector<std::string> nothing;

template <class Work>
std::string message_of(ExitStatus status, const Work& work)
{
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), status);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(OutputDirectory, IsMadeWithTheOnesAboveAndIsGoneIfNothingWasWritten)
{
  const Communicator comm;
  const Scratch scratch(comm);
  {
    const OutputDirectory output(scratch / "a/b/c", nothing, comm);
    EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/b/c"));
    comm.sum(0LL);
  }
  EXPECT_EQ(scratch.files(), Names{});
  {
    const OutputDirectory output(scratch / "a/b/c", nothing, comm);
    put(scratch / "a/b/c/summary.json", "new", comm);
  }
  comm.sum(0LL);
  EXPECT_EQ(content(scratch / "a/b/c/summary.json"), "new");
  EXPECT_FALSE(std::filesystem::exists(scratch / "a/b/c/mortise.lock"));
}

// Killed between two files, or stopped as here by one that cannot be removed, a run leaves no index of files that are gone.
TEST(OutputDirectory, WhatNamesOtherFilesIsRemovedBeforeThese)
{
  const Communicator comm;
  const Scratch scratch(comm);
  for (const char* name : {"solution.pvd", "contact.pvd", "blocks.pvd", "solution.1.pvtu", "solution.2.pvtu", "contact.1.pvtu",
                           "blocks.1.vtm", "blocks.2.vtm", "solution.1_1.vtu", "blocks.1.b0_0.vtu"})
    put(scratch / name, "old", comm);
  const OutputDirectory output(scratch / "", nothing, comm);
  if (comm.root()) std::filesystem::create_directories(scratch / "contact.1_0.vtu/full");
  comm.sum(0LL);
  EXPECT_NE(message_of(ExitStatus::machine, [&] { output.clear(); }).find("cannot be removed"), std::string::npos);
  comm.sum(0LL);
  EXPECT_EQ(scratch.files(), (Names{"solution.1_1.vtu", "contact.1_0.vtu", "mortise.lock"}));
  if (comm.root()) std::filesystem::remove_all(scratch / "contact.1_0.vtu");
}

// Files of an earlier run on seven ranks would be opened together with ours; notes of the user stay.
TEST(OutputDirectory, WhatAnEarlierRunLeftIsRemovedAndNothingElse)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const Names theirs{"notes.txt", "solution_final.vtu", "my_solution.pvd", "summary.json.bak", "plane.vtu", "planes.pvd",
                     "x.part",    "results.h5.old",     "blocks.b1.vtu",   "blocks.txt"};
  for (const char* name :
       {"solution.pvd",  "solution.pvtu",   "solution_0.vtu",    "solution_6.vtu",  "contact.pvd",        "contact_6.vtu",
        "plane.mid.pvd", "plane.mid_2.vtu", "plane.a-b.3_0.vtu", "interior.csv",    "results.h5",         "results.12.h5",
        "blocks.pvd",    "blocks.2.vtm",    "blocks.vtm",        "blocks.b1_0.vtu", "blocks.3.b12_2.vtu", "history.csv",
        "deck.yaml",     "summary.json",    "results.h5.part"})
    put(scratch / name, "old", comm);
  for (const auto& name : theirs) put(scratch / name, "mine", comm);
  {
    const OutputDirectory output(scratch.path(), nothing, comm);
    auto all = scratch.files();
    EXPECT_FALSE(all.contains("summary.json"));
    EXPECT_TRUE(all.contains("summary.old.json"));
    EXPECT_TRUE(all.contains("results.h5"));
    output.clear();
    comm.sum(0LL);
  }
  EXPECT_EQ(scratch.files(), theirs);
}

TEST(OutputDirectory, ThatCannotBeMadeIsAnErrorOnAllRanks)
{
  const Communicator comm;
  const Scratch scratch(comm);
  put(scratch / "file", "x", comm);
  for (const std::string below : {"file/out", "file"}) {
    const auto message = message_of_machine_error([&] { OutputDirectory(scratch / below, nothing, comm); });
    EXPECT_NE(message.find("output directory " + scratch / below), std::string::npos) << message;
  }
  EXPECT_EQ(content(scratch / "file"), "x");
}

TEST(OutputDirectory, WhereNothingCanBeWrittenIsFoundOutAtOnceAndLeftAsItIs)
{
  const Communicator comm;
  const Scratch scratch(comm);
  put(scratch / "summary.json", "old", comm);
  const auto message = message_of_machine_error([&] {
    const FullDisk full(0);
    OutputDirectory(scratch.path(), nothing, comm);
  });
  EXPECT_NE(message.find(scratch.path()), std::string::npos) << message;
  EXPECT_EQ(scratch.files(), Names{"summary.json"});
}

// Under whatever name the run knows it.
TEST(OutputDirectory, WhereResultsWouldReplaceWhatTheRunReadsIsRefused)
{
  namespace fs = std::filesystem;
  const Communicator comm;
  const Scratch scratch(comm);
  put(scratch / "deck.yaml", "mine", comm);
  if (comm.root()) {
    fs::create_directory_symlink(scratch.path(), scratch / "again");
    fs::create_symlink(scratch / "deck.yaml", scratch / "link");
    fs::create_hard_link(scratch / "deck.yaml", scratch / "other_name");
  }
  comm.sum(0LL);
  for (const std::string name : {"deck.yaml", "again/deck.yaml", "link", "other_name"})
    for (const std::string directory : {"", "again"}) {
      const auto message =
          message_of(ExitStatus::bad_input, [&] { OutputDirectory(scratch / directory, {scratch / name}, comm); });
      EXPECT_NE(message.find("would replace " + scratch / name), std::string::npos) << message;
    }
  EXPECT_EQ(scratch.files(), (Names{"deck.yaml", "again", "link", "other_name"}));
  EXPECT_EQ(content(scratch / "deck.yaml"), "mine");
}

TEST(OutputDirectory, ADeckOfTheUserIsNotReplacedButOneOfARunIs)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const std::string mine = "mesh: {}\nmaterials: {}\nbodies: {}\n";
  put(scratch / "deck.yaml", mine, comm);
  const auto message = message_of(ExitStatus::bad_input, [&] { OutputDirectory(scratch.path(), nothing, comm); });
  EXPECT_NE(message.find("this deck of yours"), std::string::npos) << message;
  EXPECT_EQ(content(scratch / "deck.yaml"), mine);
  comm.sum(0LL);
  for (const std::string& ours :
       {written_mark() + "\n" + mine, mine + "decomposition: {}\nsolver: {}\nfriction_loop: {}\noutput: {}\n"}) {
    put(scratch / "deck.yaml", ours, comm);
    OutputDirectory(scratch.path(), nothing, comm).clear();
    EXPECT_EQ(scratch.files(), Names{});
  }
}

TEST(OutputDirectory, ADirectoryUnderTheNameOfAResultIsFoundOutAtOnce)
{
  const Communicator comm;
  const Scratch scratch(comm);
  if (comm.root()) std::filesystem::create_directory(scratch / "results.h5");
  comm.sum(0LL);
  const auto message = message_of_machine_error([&] { OutputDirectory(scratch.path(), nothing, comm); });
  EXPECT_NE(message.find("results.h5: is a directory"), std::string::npos) << message;
}

// A process that holds the lock, as any program would take it, until it is killed.
pid_t hold_lock(const std::string& path)
{
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const int file = open(path.c_str(), O_RDWR | O_CREAT, 0666);
    struct flock whole {};
    whole.l_type = F_WRLCK;
    if (fcntl(file, F_SETLK, &whole) != 0 || write(file, "process 7 on moon\n", 18) != 18 || write(ends[1], "x", 1) != 1)
      _exit(1);
    pause();
    _exit(1);
  }
  char ready = 0;
  EXPECT_EQ(read(ends[0], &ready, 1), 1);
  close(ends[0]), close(ends[1]);
  return child;
}

TEST(OutputDirectory, WhereAnotherRunWritesIsRefusedUntilThatRunEndsHoweverItEnds)
{
  const Communicator comm;
  const Scratch scratch(comm);
  put(scratch / "summary.json", "theirs", comm);
  const pid_t child = comm.root() ? hold_lock(scratch / "mortise.lock") : 0;
  comm.sum(0LL);
  const auto message = message_of_machine_error([&] { OutputDirectory(scratch.path(), nothing, comm); });
  EXPECT_NE(message.find("another run writes there, process 7 on moon;"), std::string::npos) << message;
  EXPECT_EQ(content(scratch / "summary.json"), "theirs");
  set_aside_summary(scratch.path(), comm);
  EXPECT_EQ(scratch.files(), (Names{"mortise.lock", "summary.json"}));
  if (comm.root()) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  comm.sum(0LL);
  set_aside_summary(scratch.path(), comm);
  EXPECT_EQ(scratch.files(), Names{"summary.old.json"});
  OutputDirectory(scratch.path(), nothing, comm).clear();
  EXPECT_EQ(scratch.files(), Names{});
}

}  // namespace
}  // namespace mortise::io
