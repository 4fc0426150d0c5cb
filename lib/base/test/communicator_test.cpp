#include "base/communicator.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

using namespace mortise;

TEST(Communicator, ExchangeDeliversEachPartToItsRank)
{
  const Communicator comm;
  std::vector<std::vector<int>> send(comm.size());
  for (int r = 0; r < comm.size(); ++r) send[r].assign(r + 1, 100 * comm.rank() + r);
  const auto received = comm.exchange(send);
  for (int r = 0; r < comm.size(); ++r) EXPECT_EQ(received[r], std::vector<int>(comm.rank() + 1, 100 * r + comm.rank()));
}

TEST(Communicator, GatherConcatenatesInTheOrderOfRanks)
{
  const Communicator comm;
  const auto all = comm.all_gather(std::vector<double>(comm.rank(), comm.rank()));
  std::vector<double> expected;
  for (int r = 0; r < comm.size(); ++r) expected.insert(expected.end(), r, r);
  EXPECT_EQ(all, expected);
}

TEST(Communicator, OffsetIsTheSumOverLowerRanks)
{
  const Communicator comm;
  EXPECT_EQ(comm.offset(comm.rank() + 1), comm.rank() * (comm.rank() + 1) / 2);
}

TEST(Communicator, AnErrorOnOneRankIsThrownOnAll)
{
  const Communicator comm;
  try {
    collectively(comm, [&] {
      if (comm.rank() == comm.size() - 1) throw Error(ExitStatus::no_equilibrium, "the roller slides");
    });
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
    EXPECT_STREQ(error.what(), "the roller slides");
  }
}
