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
  EXPECT_DOUBLE_EQ(Formula("(x == -3) + 2 * (y >= 4) + 4 * (z <= 2) + 8 * (x != 0)")(x, 0), 15);
}

TEST(Formula, CopiesShareNoState)
{
  const Formula a("x"), b = a;
  EXPECT_EQ(a(Point(1, 0, 0), 0), 1);
  EXPECT_EQ(b(Point(2, 0, 0), 0), 2);
  EXPECT_EQ(a(Point(1, 0, 0), 0), 1);
}

TEST(Formula, IsTakenAtAFactorAndATime)
{
  const Formula a("x * t"), now = a.at(3, 2);
  EXPECT_EQ(now(Point(5, 0, 0), 7), 30);
  EXPECT_EQ(now.at(2, 9)(Point(5, 0, 0), 7), 60);
  EXPECT_EQ(a(Point(5, 0, 0), 7), 35);
  EXPECT_EQ(Formula(4).at(0.5, 1).constant(), 2);
  EXPECT_TRUE(now == Formula("x * t").at(3, 2));
  EXPECT_FALSE(now == a);
  EXPECT_FALSE(now == a.at(3, 1));
  EXPECT_TRUE(Formula("x * y").at(3, 2) == Formula("x * y").at(3, 1));
  EXPECT_FALSE(now == Formula(30));
  EXPECT_TRUE(Formula(4).at(0.5, 1) == Formula(2));
}

TEST(Formula, SaysWhatIsWrong)
{
  for (const char* wrong : {"10 *", "q + 1", "sin(", "x, y", "", "x=3", "(x = 1) ? 10 : 5", "0*(x==1)+(t+=2)"})
    EXPECT_THROW(Formula(std::string(wrong)), std::invalid_argument) << wrong;
}

}  // namespace
}  // namespace mortise::deck
