#include "base/interruption.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "base/error.hpp"

namespace mortise {
namespace {

std::string said(const std::function<void()>& work)
{
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::interrupted);
    EXPECT_EQ(error.cause(), Error::Cause::other);
    return error.what();
  }
  return "";
}

// Told on the last rank alone: the others learn it where they meet, and it takes its alarm back.
TEST(Interruption, EndsAllRanksWhereTheyMeet)
{
  const Communicator comm;
  EXPECT_EQ(said([&] { stop_if_requested(comm); }), "");
  const bool last = comm.rank() == comm.size() - 1;
  const auto work = [&](const std::function<void()>& look) {
    if (last) {
      request_stop(SIGTERM);
      alarm(60);
    }
    const auto text = said(look);
    EXPECT_NE(text.find("told to end (SIGTERM)"), std::string::npos) << text;
    if (last) {
      EXPECT_EQ(stop_requested(), SIGTERM);
      EXPECT_EQ(alarm(0), 0U);
    }
    request_stop(0);
  };
  work([&] { stop_if_requested(comm); });
  work([&] { collectively(comm, [] { stop_if_requested(); }); });
  EXPECT_EQ(said([] { stop_if_requested(); }), "");
}

// What a lack of memory on one rank is, it is on all.
TEST(Error, KeepsItsCauseOnAllRanks)
{
  const Communicator comm;
  const bool last = comm.rank() == comm.size() - 1;
  const auto cause = [&](const std::function<void()>& work) {
    try {
      collectively(comm, [&] {
        if (last) work();
      });
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::machine);
      return error.cause();
    }
    ADD_FAILURE();
    return Error::Cause::other;
  };
  EXPECT_EQ(cause([] { throw std::bad_alloc(); }), Error::Cause::memory);
  EXPECT_EQ(cause([] { throw Error(ExitStatus::machine, "no room for it", Error::Cause::memory); }), Error::Cause::memory);
  EXPECT_EQ(cause([] { throw Error(ExitStatus::machine, "the disk is full"); }), Error::Cause::other);
  EXPECT_EQ(cause([] { throw std::runtime_error("what else"); }), Error::Cause::other);
}

}  // namespace
}  // namespace mortise
