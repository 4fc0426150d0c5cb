// Packed lists come back as they were, and whole numbers take as few bytes as they need.
#include "base/packed.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace mortise {
namespace {

using Numbers = std::vector<Global>;

std::size_t bytes_of(const Numbers& list)
{
  PackedWriter writer;
  writer.integers(list);
  return writer.take().size();
}

TEST(Packed, ListsComeBackInTheirOrder)
{
  constexpr auto least = std::numeric_limits<Global>::min(), most = std::numeric_limits<Global>::max();
  const std::vector<Numbers> lists{
      {}, {7, 7, 7}, {-1, 254, 3}, {5000000000, 5000000255, 5000000001}, {0, 1LL << 20}, {-(1LL << 40), 1}, {least, most, 0}};
  const std::vector<double> doubles{0.1, -1e300, std::numeric_limits<double>::infinity()};
  PackedWriter writer;
  for (const auto& list : lists) writer.integers(list);
  writer.numbers(doubles);
  writer.numbers({});
  auto message = writer.take();
  EXPECT_TRUE(writer.take().empty());
  writer.integers(lists[2]);  // another message behind the first
  const auto second = writer.take();
  message.insert(message.end(), second.begin(), second.end());

  PackedReader reader(message);
  for (const auto& list : lists) EXPECT_EQ(reader.integers(), list);
  EXPECT_EQ(reader.numbers(), doubles);
  EXPECT_TRUE(reader.numbers().empty());
  EXPECT_FALSE(reader.at_end());
  EXPECT_EQ(reader.integers(), lists[2]);
  EXPECT_TRUE(reader.at_end());
}

TEST(Packed, WholeNumbersTakeTheBytesThatTheirRangeNeeds)
{
  const auto empty = bytes_of({});
  EXPECT_EQ(bytes_of({9, 9, 9, 9}), empty);
  EXPECT_EQ(bytes_of({1LL << 50, (1LL << 50) + 255}), empty + 2);
  EXPECT_EQ(bytes_of({-1, 255}), empty + 4);
  EXPECT_EQ(bytes_of({0, (1LL << 32) - 1}), empty + 8);
  EXPECT_EQ(bytes_of({0, 1LL << 32}), empty + 16);
}

TEST(Packed, AMessageThatEndsEarlyIsRefused)
{
  PackedWriter writer;
  writer.integers(Numbers{1, 2, 3});
  auto message = writer.take();
  message.pop_back();
  PackedReader reader(message);
  EXPECT_THROW(reader.integers(), std::out_of_range);
  EXPECT_THROW(PackedReader(std::span(message).first(4)).numbers(), std::out_of_range);
}

}  // namespace
}  // namespace mortise
