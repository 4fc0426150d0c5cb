// How far the fixed point goes towards its next bounds, and what comes back of a change.
#include "../src/relaxation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "testing/quiet.hpp"

namespace mortise::friction {
namespace {

// The fixed point of next = slope * now + shift, from 0: how many steps until it is known to 1e-10; 100 if never.
int steps_to_rest(double slope, double shift)
{
  const Communicator comm(MPI_COMM_SELF);
  Relaxation relaxation(comm);
  const double goal = shift / (1 - slope);
  std::vector<double> now{0.0};
  for (int step = 1; step < 100; ++step) {
    const std::vector<double> next{slope * now[0] + shift};
    now[0] += relaxation(now, next) * (next[0] - now[0]);
    if (std::abs(now[0] - goal) < 1e-10) return step;
  }
  return 100;
}

TEST(Relaxation, SettlesSwingsThatWouldGrow)
{
  for (const double slope : {-0.5, -1.0, -3.0})      // plain steps: converges, takes turns, runs away
    EXPECT_LE(steps_to_rest(slope, 1), 3) << slope;  // of one unknown the second step is exact
}

TEST(Relaxation, GoesAllTheWayAtFirstAndNeverBeyond)
{
  const Communicator comm(MPI_COMM_SELF);
  Relaxation relaxation(comm);
  EXPECT_EQ(relaxation({0}, {1}), 1);
  EXPECT_EQ(relaxation({1}, {1.9}), 1);               // steps that hardly shrink ask for 10
  EXPECT_NEAR(relaxation({1.9}, {1.0}), 0.5, 1e-12);  // 0.9 there, 0.9 back
  EXPECT_EQ(relaxation({1.45}, {100}), 0.05);         // and never less
}

// From 6 on below a point at 10 that repels: steps that grow are taken as they are, and counted.
TEST(Relaxation, LeavesAPointThatRepels)
{
  const Communicator comm(MPI_COMM_SELF);
  Relaxation relaxation(comm);
  std::vector<double> now{6.0};
  for (int step = 0; step < 5; ++step) {
    EXPECT_EQ(relaxation.growing(), std::max(step - 1, 0));
    const std::vector<double> next{1.2 * now[0] - 2};
    EXPECT_EQ(relaxation(now, next), 1);
    now = next;
  }
  relaxation(now, {now[0] + 1});
  EXPECT_EQ(relaxation.growing(), 0);
}

TEST(Relaxation, PointsThatStickWithoutALimitHaveNoSay)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const Communicator comm(MPI_COMM_SELF);
  Relaxation all(comm), one(comm);
  const std::vector<std::pair<double, double>> path{{0, 1}, {1, 0.25}, {0.5, 0.75}};
  for (const auto& [now, next] : path) EXPECT_EQ(all({now, infinite, 3}, {next, 5, infinite}), one({now}, {next}));
}

// Answers of -0.8 of a change: known from the second problem on, and not told by a change that may be rounding, nor by bounds
// that were infinite.
TEST(Response, IsKnownFromTheSecondProblemOn)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const Communicator comm(MPI_COMM_SELF);
  Response response(comm);
  const auto answer = [](double given) { return 5 - 0.8 * given; };
  response.note({infinite, 1}, {3, answer(1)});
  EXPECT_FALSE(response.part());
  response.note({3, 2}, {4, answer(2)});
  ASSERT_TRUE(response.part());
  EXPECT_NEAR(*response.part(), 0.8, 1e-12);
  response.note({3, 2 + 1e-5}, {4, 100});
  EXPECT_NEAR(*response.part(), 0.8, 1e-12);
}

// Each rank holds a part of the bounds, one of them maybe none: the step is that of all bounds.
TEST(Relaxation, IsOfTheBoundsOfAllRanks)
{
  const Communicator& comm = world();
  const Communicator alone(MPI_COMM_SELF);
  Relaxation parts(comm), whole(alone);
  const auto own = [&comm](const std::vector<double>& all) {
    std::vector<double> result;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (static_cast<int>(i) % comm.size() == comm.rank()) result.push_back(all[i]);
    return result;
  };
  const std::vector<std::pair<std::vector<double>, std::vector<double>>> path{
      {{0, 0}, {1, 4}}, {{1, 4}, {0.5, 1}}, {{1, 2}, {2, 6}}};
  std::vector<double> taken;
  for (const auto& [now, next] : path) {
    taken.push_back(whole(now, next));
    EXPECT_NEAR(parts(own(now), own(next)), taken.back(), 1e-14);
    EXPECT_EQ(parts.growing(), whole.growing());
  }
  // Steps (1, 4), (-1/2, -3), (1, 4): part (1 * 3/2 + 4 * 7) / (9/4 + 49), and of that as much once more.
  EXPECT_NEAR(taken[1], 29.5 / 51.25, 1e-14);
  EXPECT_NEAR(taken[2], taken[1] * (0.75 + 21) / 51.25, 1e-14);
}

}  // namespace
}  // namespace mortise::friction
