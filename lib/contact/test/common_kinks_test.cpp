#include "surface/common_kinks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/communicator.hpp"
#include "surface/kinks.hpp"
#include "surfaces.hpp"

namespace mortise::contact {
namespace {

TurnedEdge edge_at(const Point& middle, double normal, double turn)
{
  return {0, middle, Point::UnitY(), normal * Point::UnitZ(), 0.5, 1.0, turn};
}

TEST(CommonKinks, AValleyLiesUponARidgeInTheSamePlace)
{
  const auto valley = edge_at({0, 0, 0}, 1, 0.2);
  const auto lies_upon = [&](const TurnedEdge& other) { return !lie_upon_others(std::array{valley}, std::array{other}).empty(); };
  EXPECT_TRUE(lies_upon(edge_at({0, 0, 0}, -1, -0.2)));
  EXPECT_TRUE(lies_upon(edge_at({0.04, 0.9, 0.4}, -1, -0.3)));
  EXPECT_FALSE(lies_upon(edge_at({0.06, 0, 0}, -1, -0.2))) << "beside";
  EXPECT_FALSE(lies_upon(edge_at({0, 1.1, 0}, -1, -0.2))) << "behind its end";
  EXPECT_FALSE(lies_upon(edge_at({0, 0, 0.6}, -1, -0.2))) << "far above";
  EXPECT_FALSE(lies_upon(edge_at({0, 0, 0}, -1, 0.2))) << "valley upon valley";
  EXPECT_FALSE(lies_upon(edge_at({0, 0, 0}, 1, -0.2))) << "looks the same way";
  EXPECT_FALSE(lies_upon(edge_at({0, 0, 0}, -1, -0.5))) << "turns by more";
  auto across = edge_at({0, 0, 0}, -1, -0.2);
  across.along = Point::UnitX();
  EXPECT_FALSE(lies_upon(across));
}

// The other side of `height` over a strip, from `begin` to 1, in faces of first order; the one nearest to `begin` reaches to 0.
template <class Height>
Side strip(int faces, double begin, bool up, const Height& height, const Communicator& comm)
{
  const auto at = [&](double x, double y) {
    const double moved = begin < 0 && x < 1.0 / faces ? begin + (x * faces) * -begin : x - (begin < 0 ? 1.0 / faces : 0);
    return Point(moved, y, height(moved));
  };
  const double end = begin < 0 ? 1 + 1.0 / faces : 1;
  const int count = begin < 0 ? faces + 1 : faces;
  return gather(surface({count, 3, 0, end, 0, 0.5, up}, at, comm), fem::Kinematics::solid, comm);
}

std::vector<double> places_of(const Side& side)
{
  std::set<double> places;
  for (const auto& edge : side.kinks) {
    const auto &a = side.points[static_cast<std::size_t>(edge[0])], &b = side.points[static_cast<std::size_t>(edge[1])];
    EXPECT_NEAR(a[0], b[0], 1e-12);
    places.insert(std::round(1e6 * a[0]) / 1e6);
  }
  return {places.begin(), places.end()};
}

// Arcs that turn by 6 and 5 degrees a face meet at 10 degrees, one face from the border: neither side alone tells.
TEST(CommonKinks, EdgesOneFaceFromTheBorderAreFoundTogether)
{
  const Communicator comm;
  const double slope = std::tan(5 * std::numbers::pi / 180);
  const auto arcs = [&](double x) { return -x * x / 6 - slope * std::abs(x); };
  auto lower = strip(3, -0.3, true, arcs, comm), upper = strip(4, -0.3, false, arcs, comm);
  find_kinks(lower);
  find_kinks(upper);
  EXPECT_TRUE(lower.kinks.empty() && upper.kinks.empty());
  find_kinks(lower, upper);
  EXPECT_EQ(places_of(lower), std::vector{0.0});
  EXPECT_EQ(places_of(upper), std::vector{0.0});
}

// A step of 0.3 between two planes, one face of the lower side and two of the upper one.
TEST(CommonKinks, BothEdgesOfAStripOneFaceWideAreFoundTogether)
{
  const Communicator comm;
  const auto step = [&](int faces, int on_step, bool up, double first) {
    std::vector<double> x{0};
    const auto add = [&](double to, int count) {
      for (const double from = x.back(), part = (to - from) / count; count > 0; --count) x.push_back(x.back() + part);
    };
    add(first, faces), add(first + 0.3, on_step), add(3, faces);
    const auto at = [&](double i, double y) {
      const double place = x[static_cast<std::size_t>(std::lround(i))];
      return Point(place, y, 0.2 * std::clamp(place - first, 0.0, 0.3));
    };
    const int count = static_cast<int>(x.size()) - 1;
    return gather(surface({count, 3, 0, static_cast<double>(count), 0, 0.5, up}, at, comm), fem::Kinematics::solid, comm);
  };
  auto lower = step(2, 1, true, 1.4), upper = step(5, 2, false, 1.4);
  find_kinks(lower, upper);
  EXPECT_EQ(places_of(lower), (std::vector{1.4, 1.7}));
  EXPECT_EQ(places_of(upper), (std::vector{1.4, 1.7}));
  auto beside = step(4, 2, false, 1.5);
  find_kinks(lower = step(2, 1, true, 1.4), beside);
  EXPECT_TRUE(lower.kinks.empty());  // nothing lies upon its edges
}

// But with four faces a wave, which may be a zigzag.
TEST(CommonKinks, EdgesOfUnlikeMeshesOfOneWaveAreNone)
{
  const Communicator comm;
  for (const auto& [lower_faces, upper_faces] : {std::pair(6, 9), std::pair(10, 15), std::pair(9, 6)})
    for (double phase = 0; phase < 6; phase += 0.3) {
      const auto wave = [&](double x) { return 0.02 * std::cos(4 * std::numbers::pi * x + phase); };
      auto lower = strip(lower_faces, 0, true, wave, comm), upper = strip(upper_faces, 0, false, wave, comm);
      find_kinks(lower, upper);
      EXPECT_TRUE(lower.kinks.empty() && upper.kinks.empty()) << lower_faces << ":" << upper_faces << ", phase " << phase;
    }
}

}  // namespace
}  // namespace mortise::contact
