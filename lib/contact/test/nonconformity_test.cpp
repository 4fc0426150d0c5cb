// What is left of a known jump of displacements, on any ranks.
#include "contact/nonconformity.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

// Two flat sides over [0, 2] x [0, 1] that touch: the secondary one has 2 x 1 faces, the primary one n x 1.
struct Sides {
  Communicator comm;
  std::vector<Pair> pairs;

  explicit Sides(int n, Law law = Law::frictionless)
  {
    const auto flat = [](double x, double y) { return Point(x, y, 0); };
    const auto secondary = surface({2, 1, 0, 2, 0, 1, false}, flat, comm);
    const auto primary = surface({n, 1, 0, 2, 0, 1, true, false, primary_ids}, flat, comm);
    pairs.push_back(make_pair(secondary, primary, law));
  }

  // The primary side goes by `move` along `axis`, and both go far away together; the secondary nodes where `presses` holds press,
  // and stick or slip.
  Nonconformity found(
      const std::function<double(const Point&)>& move,
      const std::function<bool(const Point&)>& presses = [](const Point&) { return true; }, Status status = Status::slip,
      std::size_t axis = 2) const
  {
    std::vector<NodalDisplacement> u;
    const auto& [options, secondary, primary] = pairs[0];
    for (std::size_t i = 0; i < secondary.points.size(); ++i) u.push_back({secondary.node_id[i], {30, 20, 10}});
    for (std::size_t i = 0; i < primary->points.size(); ++i) {
      u.push_back({primary->node_id[i], {30, 20, 10}});
      u.back().u[axis] += move(primary->points[i]);
    }
    SurfaceState state;
    for (const auto& x : secondary.points) {
      state.pressure.push_back(presses(x) ? 1 : 0);
      state.status.push_back(static_cast<int>(presses(x) ? status : Status::open));
    }
    return nonconformities(pairs, std::vector{state}, u, fem::Kinematics::solid, comm).front();
  }
};

double linear(const Point& x)
{
  return 0.1 + 0.2 * x[0] - 0.3 * x[1] + 0.05 * x[0] * x[1];
}

// Teeth of height 1 and length 1 over faces of length 1.
double teeth(const Point& x)
{
  return static_cast<int>(std::lround(2 * x[0])) % 2 == 0 ? 0.0 : 1.0;
}

// What is counted of a face where it exceeds the mean square of w.
double product(double square, double square_of_slope)
{
  return std::sqrt(square * square_of_slope) / (2 * std::numbers::pi);
}

TEST(Nonconformity, NothingIsLeftOfWhatMultipliersSee)
{
  for (const int n : {1, 2, 5}) EXPECT_LT(Sides(n).found(linear).squared, 1e-24) << n;
}

TEST(Nonconformity, OfTeethTheirMeanIsSeen)
{
  const auto found = Sides(4).found(teeth);
  // A tooth less its mean of 1/2 has the mean square 1/12, and its slope the mean square 4; two faces of area and size 1.
  EXPECT_NEAR(found.squared, 2 * product(1.0 / 12, 4), 1e-12);
  EXPECT_GT(found.largest, 0.4);
  EXPECT_LE(found.largest, 0.5);
  EXPECT_NEAR(std::abs(found.at[0] - 1), 0.5, 0.05);
}

TEST(Nonconformity, CountsWhereTheContactPresses)
{
  const Sides sides(4);
  EXPECT_EQ(sides.found(teeth, [](const Point&) { return false; }).squared, 0);
  // Of the second face the nodes at one end: the part that presses falls from 1 to 0, and with its square the mean is 7/240; in
  // the middles of its halves the product has the slopes 3/2 and -1/2.
  EXPECT_NEAR(sides.found(teeth, [](const Point& x) { return x[0] < 1.5; }).squared,
              product(1.0 / 12, 4) + product(7.0 / 240, (2.25 + 0.25) / 2), 1e-12);
}

TEST(Nonconformity, AlongFacesWhereTheyStick)
{
  const Sides sides(4);
  const auto everywhere = [](const Point&) { return true; };
  EXPECT_NEAR(sides.found(teeth, everywhere, Status::stick, 0).squared, 2 * product(1.0 / 12, 4), 1e-12);
  EXPECT_LT(sides.found(teeth, everywhere, Status::slip, 0).squared, 1e-24);
}

TEST(Nonconformity, InBondsEveryJumpCountsButWhereTheyAreDrawnTogether)
{
  Sides sides(4, Law::bonded);
  const auto everywhere = [](const Point&) { return true; };
  for (const std::size_t axis : {0, 1, 2})  // the mean square of a tooth is 1/3
    EXPECT_NEAR(sides.found(teeth, everywhere, Status::stick, axis).squared, 2.0 / 3, 1e-12);  // more than product(1.0 / 3, 4)
  sides.pairs[0].options.preload.emplace();
  EXPECT_EQ(sides.found(teeth).squared, 0);
}

}  // namespace
}  // namespace mortise::contact
