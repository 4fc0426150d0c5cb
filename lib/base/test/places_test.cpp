#include "base/places.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

using namespace mortise;

namespace {

using Key = std::array<double, 2>;

// As a rank that holds all keys would number them.
std::vector<Global> reference(const std::vector<Key>& own, const Communicator& comm)
{
  using Numbered = std::tuple<Key, int, std::size_t>;
  std::vector<Numbered> mine;
  for (std::size_t i = 0; i < own.size(); ++i) mine.emplace_back(own[i], comm.rank(), i);
  std::vector<Key> keys = comm.all_gather(own);
  std::vector<int> ranks = comm.all_gather(std::vector<int>(own.size(), comm.rank()));
  std::vector<std::size_t> at(own.size());
  std::iota(at.begin(), at.end(), std::size_t{0});
  at = comm.all_gather(at);
  std::vector<Numbered> all;
  for (std::size_t i = 0; i < keys.size(); ++i) all.emplace_back(keys[i], ranks[i], at[i]);
  std::sort(all.begin(), all.end());
  std::vector<Global> places;
  for (const auto& k : mine) places.push_back(std::lower_bound(all.begin(), all.end(), k) - all.begin());
  return places;
}

std::vector<Key> random_keys(std::size_t count, int different, int seed)
{
  std::minstd_rand random(static_cast<unsigned>(seed));
  std::vector<Key> keys;
  for (std::size_t i = 0; i < count; ++i)
    keys.push_back({static_cast<double>(random() % 3), static_cast<double>(random() % static_cast<unsigned>(different))});
  return keys;
}

}  // namespace

TEST(PlacesAmongAll, AreThoseOfOneRankThatHoldsAllKeys)
{
  const Communicator comm;
  const auto own = random_keys(static_cast<std::size_t>(100 + 70 * comm.rank()), 1000000, 17 + comm.rank());
  EXPECT_EQ(places_among_all(own, comm), reference(own, comm));
}

TEST(PlacesAmongAll, EqualKeysComeByRankAndAsGiven)
{
  const Communicator comm;
  const auto own = random_keys(60, 4, 5 + comm.rank());
  EXPECT_EQ(places_among_all(own, comm), reference(own, comm));
  const std::vector<Key> same(5, Key{1, 2});
  EXPECT_EQ(places_among_all(same, comm), reference(same, comm));
}

TEST(PlacesAmongAll, RanksMayHaveNone)
{
  const Communicator comm;
  const auto own = random_keys(comm.rank() == comm.size() - 1 ? 7 : 0, 9, 3);
  EXPECT_EQ(places_among_all(own, comm), reference(own, comm));
  EXPECT_TRUE(places_among_all(std::vector<Key>{}, comm).empty());
}
