#include "deck/formula.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace mortise::deck {
namespace {

TEST(Formula, HasItsValueAtAPlaceAndTime)
{
  EXPECT_EQ(Formula(2.5)(Point(1, 2, 3), 4), 2.5);
  const Point x(-3, 4, 2);
  EXPECT_DOUBLE_EQ(Formula("10 * (1 - z / 5)")(x, 0), 6);
  EXPECT_DOUBLE_EQ(Formula("r * cos(theta) + t")(x, 0.5), -2.5);
  EXPECT_DOUBLE_EQ(Formula("theta / pi")(Point(-1, 0, 0), 0), 1);
  EXPECT_DOUBLE_EQ(Formula("x < 0 ? y^2 : 0")(x, 0), 16);
  EXPECT_TRUE(std::isinf(Formula("1 / (z - 2)")(x, 0)));
}

TEST(Formula, CopiesShareNoState)
{
  const Formula a("x"), b = a;
  EXPECT_EQ(a(Point(1, 0, 0), 0), 1);
  EXPECT_EQ(b(Point(2, 0, 0), 0), 2);
  EXPECT_EQ(a(Point(1, 0, 0), 0), 1);
}

TEST(Formula, SaysWhatIsWrong)
{
  for (const char* wrong : {"10 *", "q + 1", "sin(", "x, y", ""})
    EXPECT_THROW(Formula(std::string(wrong)), std::invalid_argument) << wrong;
}

}  // namespace
}  // namespace mortise::deck
