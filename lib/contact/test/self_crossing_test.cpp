// Bodies whose faces pass through each other. Depths follow from the drawings.
#include "contact/self_crossing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "outer_faces.hpp"

namespace mortise::contact {
namespace {

using Motion = std::function<Point(const Point&)>;

fem::Kinematics kinematics_of(const OuterFaces& skin)
{
  return skin.faces[0].size() == 2 ? fem::Kinematics::plane_strain : fem::Kinematics::solid;
}

std::vector<Interpenetration> crossings_of(const OuterFaces& skin, const Motion& displacement, const ContactSides& sides = {})
{
  const Communicator comm;
  auto after = skin;
  for (auto& x : after.points) x += displacement(x);
  return find_self_crossings(
      skin.on_rank(comm), after.on_rank(comm), [&] { return sides; }, 0.01, kinematics_of(skin), comm);
}

double deepest_crossing(const std::vector<Interpenetration>& places)
{
  double depth = 0;
  for (const auto& place : places) depth = std::max(depth, place.depth);
  return depth;
}

// A line through these corners, in cells of about `cell`.
std::vector<Point> subdivided(const std::vector<Point>& corners, double cell)
{
  std::vector<Point> line;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const int cells = static_cast<int>(std::ceil((b - a).norm() / cell - 1e-9));  // none where two corners are one
    for (int k = 0; k < cells; ++k) line.push_back(a + (b - a) * k / cells);
  }
  return line;
}

// Two legs, 8 long and 2 thick, with a gap between them, and a web, 2 wide.
std::vector<Point> fork(double gap)
{
  return subdivided(
      {{0, 0, 0}, {10, 0, 0}, {10, 2, 0}, {2, 2, 0}, {2, 2 + gap, 0}, {10, 2 + gap, 0}, {10, 4 + gap, 0}, {0, 4 + gap, 0}}, 1);
}

// Legs turn towards each other; at their tips each moves by `step`.
Motion closing(double gap, double step)
{
  return [=](const Point& x) { return Point(0, (x[1] < 2 + gap / 2 ? 1 : -1) * step * std::max(0.0, x[0] - 2) / 8, 0); };
}

OuterFaces plane(const std::vector<Point>& line)
{
  OuterFaces skin;
  skin.add_line(0, line);
  return skin;
}

// Moved along z by `depth` in cells of 1, without its ends.
OuterFaces extruded(const std::vector<Point>& line, int depth)
{
  OuterFaces skin;
  const auto n = static_cast<Local>(line.size());
  for (int k = 0; k <= depth; ++k)
    for (const auto& x : line) skin.points.emplace_back(x[0], x[1], k);
  for (Local k = 0; k < depth; ++k)
    for (Local i = 0; i < n; ++i) {
      const Local j = (i + 1) % n;
      skin.faces.push_back({k * n + i, k * n + j, (k + 1) * n + j, (k + 1) * n + i});
      skin.body.push_back(0);
    }
  return skin;
}

// The tips of the legs are 0.3 in each other, along a face that is inclined by 0.05.
TEST(SelfCrossing, LegsOfAFork)
{
  const double depth = 0.3 * std::cos(std::atan(0.05));
  for (const auto& skin : {plane(fork(0.5)), extruded(fork(0.5), 3)}) {
    EXPECT_TRUE(crossings_of(skin, closing(0.5, 0.2)).empty());
    EXPECT_TRUE(crossings_of(skin, closing(0.5, -3)).empty());
    const auto found = crossings_of(skin, closing(0.5, 0.4));
    EXPECT_NEAR(deepest_crossing(found), depth, 1e-9);
    const auto tip = *std::ranges::max_element(found, {}, &Interpenetration::depth);
    EXPECT_EQ(tip.body, 0);
    EXPECT_EQ(tip.other, 0);
    EXPECT_NEAR(tip.at[0], 10, 1e-12);
    EXPECT_NEAR(std::abs(tip.at[1] - 2.25), 0.25, 1e-12);
  }
}

// Less than a hundredth of what moves in the body is none; what the body does as a whole does not count.
TEST(SelfCrossing, NextToNothing)
{
  const auto skin = plane(fork(0.5));
  EXPECT_TRUE(crossings_of(skin, closing(0.5, 0.2501)).empty());
  const auto with_all = [](const Point& x) -> Point { return Point(5, 2, 0) + closing(0.5, 0.26)(x); };
  EXPECT_NEAR(deepest_crossing(crossings_of(skin, with_all)), 0.02, 1e-4);
}

// A fork whose gap the sides of a contact are: nothing more to say.
TEST(SelfCrossing, SidesOfAContact)
{
  const auto skin = plane(fork(0.5));
  ContactSides sides, others;
  for (std::size_t f = 0; f < skin.faces.size(); ++f) {
    const double y = (skin.points[static_cast<std::size_t>(skin.faces[f][0])][1] - 2.25);
    sides.of_face[static_cast<Global>(f)] = {y < 0 ? 2 : 3};
    others.of_face[static_cast<Global>(f)] = {y < 0 ? 2 : 5};
  }
  EXPECT_TRUE(crossings_of(skin, closing(0.5, 0.4), sides).empty());
  EXPECT_FALSE(crossings_of(skin, closing(0.5, 0.4), others).empty());
}

// Linearised rotations blow bodies up and keep their faces apart, also those of narrow gaps.
TEST(SelfCrossing, LinearizedRotation)
{
  for (const double gap : {0.5, 1e-3}) {
    EXPECT_TRUE(crossings_of(plane(fork(gap)), [](const Point& x) -> Point { return 3 * Point(-x[1], x[0], 0); }).empty());
    EXPECT_TRUE(crossings_of(extruded(fork(gap), 3), [](const Point& x) -> Point { return Point(0.3, -2, 1).cross(x); }).empty());
  }
  OuterFaces box;
  box.add_box(0, Point(0, 0, 0), Point(3, 2, 0.01), {6, 4, 1});
  EXPECT_TRUE(crossings_of(box, [](const Point& x) -> Point { return Point(5, -2, 1).cross(x); }).empty());
}

// A node of a plate that is pushed through its other side, and one of a re-entrant corner that goes into the body: cells turned
// inside out.
TEST(SelfCrossing, CellsInsideOut)
{
  OuterFaces plate;
  plate.add_box(0, Point(0, 0, 0), Point(6, 6, 0.5), {6, 6, 1});
  const auto push = [](const Point& x) { return Point(0, 0, (x - Point(3, 3, 0.5)).norm() < 1e-9 ? -0.8 : 0.0); };
  EXPECT_TRUE(crossings_of(plate, push).empty());
  const auto corner = subdivided({{0, 0, 0}, {6, 0, 0}, {6, 3, 0}, {3, 3, 0}, {3, 6, 0}, {0, 6, 0}}, 1);
  for (const double way : {-0.4, 0.4, 1.2, -1.2})
    for (const auto& skin : {plane(corner), extruded(corner, 3)})
      EXPECT_TRUE(crossings_of(skin, [&](const Point& x) {
                    return Point(std::abs(x[0] - 3) + std::abs(x[1] - 3) < 1e-9 ? Point(way, way, 0) : Point(0, 0, 0));
                  }).empty());
}

// Faces that lie on each other from the start: with the same corners they are a seam, of which nothing else is told whether it
// closes or opens; with others they may open.
TEST(SelfCrossing, FacesThatTouch)
{
  const auto seam = fork(0);
  EXPECT_TRUE(crossings_of(plane(seam), closing(0, 0.4)).empty());
  EXPECT_TRUE(crossings_of(extruded(seam, 2), closing(0, 0.4)).empty());
  const std::vector<Point> crack{{0, 0, 0},   {10, 0, 0},  {10, 2, 0}, {9.3, 2, 0}, {4.1, 2, 0}, {2, 2, 0},
                                 {4.7, 2, 0}, {8.2, 2, 0}, {10, 2, 0}, {10, 4, 0},  {0, 4, 0}};
  auto skin = plane(crack);
  std::vector<char> upper(crack.size(), 0);
  for (std::size_t n = 6; n < upper.size(); ++n) upper[n] = 1;
  const auto open = [&](double step) {
    const Communicator comm;
    auto after = skin;
    for (std::size_t n = 0; n < upper.size(); ++n)
      after.points[n][1] += (upper[n] ? step : -step) * std::max(0.0, crack[n][0] - 2) / 8;
    return find_self_crossings(
        skin.on_rank(comm), after.on_rank(comm), [] { return ContactSides{}; }, 0.01, fem::Kinematics::plane_strain, comm);
  };
  EXPECT_TRUE(open(0.3).empty());
}

}  // namespace
}  // namespace mortise::contact
