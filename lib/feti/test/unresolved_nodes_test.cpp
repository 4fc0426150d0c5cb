// What a solve leaves open: the record of states, how wide a band of open points is.
#include "feti/unresolved_nodes.hpp"

#include <gtest/gtest.h>

#include "feti/state_record.hpp"

namespace mortise::feti {
namespace {

using enum ContactStatus;

TEST(StateRecord, CountsTurnsOfContactAndFrictionApart)
{
  StateRecord record;
  EXPECT_EQ(record.steps(), -1);
  EXPECT_EQ(record.note({open, closed, sticks, slips}), 0);
  EXPECT_EQ(record.note({closed, closed, slips, open}), 3);
  EXPECT_EQ(record.note({open, closed, sticks, sticks}), 3);
  EXPECT_EQ(record.note({open, closed, slips, slips}), 2);
  const auto changes = record.changes();
  ASSERT_EQ(changes.size(), 4U);
  EXPECT_EQ(record.steps(), 3);
  EXPECT_EQ(changes[0].contact, 2);
  EXPECT_EQ(changes[1].contact + changes[1].friction, 0);
  EXPECT_EQ(changes[2].friction, 3);
  EXPECT_EQ(changes[2].contact, 0);
  EXPECT_EQ(changes[3].contact, 2);  // slips, open, sticks
  EXPECT_EQ(changes[3].friction, 1);
}

TEST(StateRecord, ForgetsWhatIsLongAgo)
{
  StateRecord record;
  for (const auto state : {open, closed, open, closed}) record.note({state});
  EXPECT_EQ(record.changes()[0].contact, 3);
  for (int i = 0; i < StateRecord::kept; ++i) EXPECT_EQ(record.note({closed}), 0);
  EXPECT_EQ(record.changes()[0].contact, 0);
  EXPECT_EQ(record.steps(), StateRecord::kept);
  record.note({closed, open});  // other points
  EXPECT_EQ(record.steps(), 0);
}

// A row of points with spacings that grow, some of them open.
std::vector<BandPoint> row(const std::string& states, double growth = 1)
{
  std::vector<BandPoint> places;
  double x = 0, step = 1;
  for (const char c : states) {
    places.push_back({Point(x, 0, 0), c == '?'});
    x += step;
    step *= growth;
  }
  return places;
}

TEST(WidestBand, OfARowIsTheCellsBetweenDecidedPoints)
{
  EXPECT_EQ(widest_band(row("xxxxx")), 0);
  EXPECT_EQ(widest_band(row("xx?xx")), 2);
  EXPECT_EQ(widest_band(row("xx??xx")), 3);
  EXPECT_EQ(widest_band(row("x?xx???xx")), 4);
  EXPECT_EQ(widest_band(row("xxxx??")), 2);  // up to the end of the surface
  EXPECT_EQ(widest_band(row("????")), 4);    // nothing is decided
  EXPECT_EQ(widest_band(row("xx?xx", 1.2)), 2);
}

TEST(WidestBand, OfARingIsItsThicknessWhereverOneLooks)
{
  constexpr int n = 41, middle = 20;
  for (const int rows : {1, 2, 4}) {
    std::vector<BandPoint> places;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double radius = std::hypot(i - middle, j - middle);
        places.push_back({Point(0.1 * i, 0.3 * j, 0), radius >= 10 && radius < 10 + rows});  // cells three times as long as wide
      }
    const int width = widest_band(places);
    EXPECT_GE(width, rows + 1);
    EXPECT_LE(width, rows + 2);  // steps of the ring
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.4, Point(1, 2, 3).normalized()).matrix();
    for (auto& p : places) p.at = turned * p.at;
    EXPECT_EQ(widest_band(places), width);
  }
}

}  // namespace
}  // namespace mortise::feti
