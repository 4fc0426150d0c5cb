// Known exchanges and what they must count, Mortise's own and MPI's plain calls, as libraries make them.
#include "base/traffic.hpp"

#include <gtest/gtest.h>

#include "base/timer.hpp"

namespace mortise {
namespace {

// What `work` sends on this rank.
template <class Work>
Traffic during(const Work& work)
{
  const Traffic before = traffic();
  work();
  return traffic() - before;
}

void expect(const Traffic& found, long long messages, long long bytes, long long collectives, long long collective_bytes)
{
  EXPECT_EQ(found.messages, messages);
  EXPECT_EQ(found.bytes, bytes);
  EXPECT_EQ(found.collectives, collectives);
  EXPECT_EQ(found.collective_bytes, collective_bytes);
}

TEST(Traffic, OfAnExchangeIsItsPartsForOthers)
{
  const Communicator comm;
  const int ranks = comm.size();
  std::vector<std::vector<double>> send(static_cast<std::size_t>(ranks));
  long long bytes = 0;  // rank r gets r + 1 numbers
  for (int r = 0; r < ranks; ++r) {
    send[static_cast<std::size_t>(r)].assign(static_cast<std::size_t>(r) + 1, 1.0);
    if (r != comm.rank()) bytes += 8 * (r + 1);
  }
  // The lengths go before, 8 bytes a rank.
  const bool alone = ranks == 1;
  expect(during([&] { comm.exchange(send); }), ranks - 1, bytes, alone ? 0 : 1, alone ? 0 : 8 * ranks);
}

TEST(Traffic, OfReductionsIsTheirLength)
{
  const Communicator comm;
  const bool alone = comm.size() == 1;
  std::vector<double> x(25, 1.0);
  expect(during([&] {
           comm.sum_in_place(x);
           comm.max(1LL);
           comm.broadcast(x);  // its length before it
         }),
         0, 0, alone ? 0 : 4, alone ? 0 : 200 + 8 + 8 + 200);
}

// Each rank hands in 3 ints and gets those of all.
TEST(Traffic, OfAGatherIsWhatComes)
{
  const Communicator comm;
  const bool alone = comm.size() == 1;
  const std::vector<int> mine(3, comm.rank());
  std::vector<int> all(3 * static_cast<std::size_t>(comm.size()));
  expect(during([&] { MPI_Allgather(mine.data(), 3, MPI_INT, all.data(), 3, MPI_INT, comm.mpi()); }), 0, 0, alone ? 0 : 1,
         alone ? 0 : 12 * comm.size());
}

TEST(Traffic, OfAMessageToItselfIsNothing)
{
  const Communicator comm;
  int in = 0, out = 7;
  expect(during([&] {
           MPI_Sendrecv(&out, 1, MPI_INT, comm.rank(), 0, &in, 1, MPI_INT, comm.rank(), 0, comm.mpi(), MPI_STATUS_IGNORE);
         }),
         0, 0, 0, 0);
  EXPECT_EQ(in, 7);
}

// Stages that nest count all of what is within.
TEST(Traffic, OfAStageIsThatOfItsScopes)
{
  const Communicator comm;
  const long long calls = comm.size() == 1 ? 0 : 1;
  Timers timers;
  for (int time = 0; time < 2; ++time) {
    const auto outer = timers.scope("outer");
    comm.sum(1.0);
    const auto inner = timers.scope("inner");
    comm.sum(1.0);
  }
  expect(timers.traffic("outer"), 0, 0, 4 * calls, 32 * calls);
  expect(timers.traffic("inner"), 0, 0, 2 * calls, 16 * calls);
  expect(timers.traffic("never"), 0, 0, 0, 0);
}

}  // namespace
}  // namespace mortise
