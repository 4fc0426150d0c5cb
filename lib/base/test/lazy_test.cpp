#include "base/lazy.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace mortise {
namespace {

TEST(Lazy, IsMadeOnceAndWhenItIsAskedFor)
{
  int made = 0;
  const Lazy<int> value([&] { return ++made; });
  EXPECT_EQ(made, 0);
  EXPECT_EQ(value.get(), 1);
  EXPECT_EQ(&value.get(), &value.get());
  EXPECT_EQ(made, 1);
}

TEST(Lazy, IsMadeAgainIfThatThrew)
{
  int tries = 0;
  const Lazy<int> value([&] { return ++tries < 2 ? throw std::runtime_error("not yet") : 7; });
  EXPECT_THROW(value.get(), std::runtime_error);
  EXPECT_EQ(value.get(), 7);
}

}  // namespace
}  // namespace mortise
