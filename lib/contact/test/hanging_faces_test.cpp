// Faces of a body that lie on others with other corners.
#include "contact/hanging_faces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "outer_faces.hpp"

namespace mortise::contact {
namespace {

std::size_t faces_on_others(const OuterFaces& skin, fem::Kinematics kinematics)
{
  const Communicator comm;
  std::set<Global> result;
  for (const auto& two : find_hanging_faces(skin.on_rank(comm), kinematics, comm)) result.insert(two.middle_of);
  return result.size();
}

// Two boxes of different meshes, as one body: 4 and 9 faces lie on each other. Not those of two bodies, nor with equal corners,
// nor apart, nor in each other.
TEST(HangingFaces, BetweenBoxes)
{
  const auto found = [](int body, const Point& origin, std::array<int, 3> cells) {
    OuterFaces skin;
    skin.add_box(0, Point(0, 0, 0), Point(2, 2, 2), {2, 2, 2});
    skin.add_box(body, origin, Point(2, 2, 2), cells);
    return faces_on_others(skin, fem::Kinematics::solid);
  };
  EXPECT_EQ(found(0, Point(2, 0, 0), {2, 3, 3}), 13u);
  EXPECT_EQ(found(0, Point(2, 0, 0), {2, 4, 4}), 20u);
  EXPECT_EQ(found(0, Point(2.00005, 0, 0), {2, 3, 3}), 13u);
  EXPECT_EQ(found(0, Point(2.0003, 0, 0), {2, 3, 3}), 0u);
  EXPECT_EQ(found(0, Point(1.999, 0, 0), {2, 3, 3}), 0u);
  EXPECT_EQ(found(0, Point(2, 0, 0), {2, 2, 2}), 0u);
  EXPECT_EQ(found(1, Point(2, 0, 0), {2, 3, 3}), 0u);
}

// A half of a disc in that of a ring, of facets of other lengths: the sagitta of one side is up to four times that of the other.
// A slit of half of it is one; so are thin half rings, whose sides look away from each other.
TEST(HangingFaces, OnCurvedSeams)
{
  const auto found = [](double inside, double outside, int facets, int others) {
    const auto arc = [](double radius, int n, bool back) {
      std::vector<Point> points;
      for (int i = 0; i <= n; ++i) {
        const double angle = std::numbers::pi * (back ? n - i : i) / n;
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
      }
      return points;
    };
    OuterFaces skin;
    skin.add_line(0, arc(inside, facets, false));
    auto ring = arc(2, 24, false);
    const auto bore = arc(outside, others, true);
    ring.insert(ring.end(), bore.begin(), bore.end());
    skin.add_line(0, ring);
    return faces_on_others(skin, fem::Kinematics::plane_strain);
  };
  EXPECT_EQ(found(1, 1, 8, 12), 20u);
  EXPECT_EQ(found(1, 1, 7, 13), 20u);
  EXPECT_EQ(found(1, 1, 16, 8), 24u);
  const double sagitta = 1 - std::cos(std::numbers::pi / 16);
  EXPECT_EQ(found(1, 1 + 0.6 * sagitta, 8, 12), 0u);
  EXPECT_EQ(found(1, 1.99, 8, 6), 0u);
}

}  // namespace
}  // namespace mortise::contact
