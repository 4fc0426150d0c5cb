// Bodies that move into each other, or do not. Depths follow from the drawings.
#include "contact/interpenetration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "outer_faces.hpp"

namespace mortise::contact {
namespace {

// Body 1 moves by `step`, body 0 stays.
std::vector<Interpenetration> moved(const OuterFaces& skin, const Point& step, const ContactSides& sides = {})
{
  const Communicator comm;
  auto after = skin;
  std::vector<char> turn(skin.points.size(), 0);
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    for (const Local n : skin.faces[f]) turn[static_cast<std::size_t>(n)] = skin.body[f] == 1;
  for (std::size_t n = 0; n < turn.size(); ++n)
    if (turn[n]) after.points[n] += step;
  const bool plane = skin.faces[0].size() == 2;
  return find_interpenetrations(
      skin.on_rank(comm), after.on_rank(comm), 1 + *std::ranges::max_element(skin.body), [&] { return sides; },
      {0.01 * step.norm(), 2 * step.norm()}, plane ? fem::Kinematics::plane_strain : fem::Kinematics::solid, comm);
}

double deepest(const std::vector<Interpenetration>& places)
{
  double depth = 0;
  for (const auto& place : places) depth = std::max(depth, place.depth);
  return depth;
}

// What stands deepest in the other body.
Interpenetration deepest_of(const std::vector<Interpenetration>& places)
{
  return *std::ranges::max_element(places, {}, &Interpenetration::depth);
}

OuterFaces block()
{
  OuterFaces skin;
  skin.add_box(0, Point(0, 0, 0), Point(1, 1, 1), {2, 2, 2});
  return skin;
}

// A cube stands on its corner, 0.1 above the middle of the block's face, and comes down by 0.25.
TEST(Interpenetration, CornerInAFace)
{
  auto skin = block();
  const auto first = skin.points.size();
  skin.add_box(1, Point(0, 0, 0), Point(1, 1, 1), {2, 2, 2});
  const auto on_its_corner = Eigen::Quaterniond::FromTwoVectors(Point(1, 1, 1), Point(0, 0, 1));
  for (std::size_t n = first; n < skin.points.size(); ++n) skin.points[n] = on_its_corner * skin.points[n] + Point(0.4, 0.4, 1.1);
  EXPECT_TRUE(moved(skin, Point(0, 0, -0.099)).empty());
  EXPECT_TRUE(moved(skin, Point(0, 0, -0.101)).empty());  // 0.001 is less than a hundredth of the way
  const auto found = moved(skin, Point(0, 0, -0.25));
  ASSERT_FALSE(found.empty());
  const auto corner = deepest_of(found);
  EXPECT_EQ(corner.body, 1);
  EXPECT_EQ(corner.other, 0);
  EXPECT_NEAR(corner.depth, 0.15, 1e-12);
  EXPECT_NEAR((corner.at - Point(0.4, 0.4, 1.1)).norm(), 0, 1e-12);
}

// A bar through a plate of one cell, and two crossed ones: no node and no middle of a facet lies in the other body, edges do.
TEST(Interpenetration, EdgesThroughFacets)
{
  OuterFaces skin;
  skin.add_box(0, Point(0, 0, 0), Point(10, 10, 0.2), {1, 1, 1});
  skin.add_box(1, Point(2, 3, -0.6), Point(1, 1, 2), {1, 1, 1});
  auto found = moved(skin, Point(0, 0, 1e-6));
  EXPECT_EQ(found.size(), 4u);
  for (const auto& place : found) {
    EXPECT_EQ(place.body, 1);
    EXPECT_NEAR(place.depth, 0.1, 1e-9);
  }
  OuterFaces bars;
  bars.add_box(0, Point(0, 4, 0), Point(10, 1, 1), {3, 1, 1});
  bars.add_box(1, Point(4, 0, 1.01), Point(1, 10, 1), {1, 3, 1});
  EXPECT_TRUE(moved(bars, Point(0, 0, -0.01)).empty());  // they touch
  found = moved(bars, Point(0, 0, -0.41));
  EXPECT_EQ(found.size(), 4u);
  EXPECT_NEAR(deepest(found), 0.4, 1e-9);
}

// All of a small cube, 0.4 deep on every side. Its 8 nodes and the middles of its 6 faces.
TEST(Interpenetration, WhollyInside)
{
  auto skin = block();
  skin.add_box(1, Point(1.1, 0.4, 0.4), Point(0.2, 0.2, 0.2), {1, 1, 1});
  const auto found = moved(skin, Point(-0.7, 0, 0));
  EXPECT_EQ(found.size(), 14u);
  for (const auto& place : found) {
    EXPECT_EQ(place.body, 1);
    EXPECT_NEAR(place.depth, 0.4, 1e-12);
  }
}

std::vector<Interpenetration> enclosed(const OuterFaces& skin, const ContactSides& sides = {})
{
  const Communicator comm;
  const auto surface = skin.on_rank(comm);
  const auto kinematics = skin.faces[0].size() == 2 ? fem::Kinematics::plane_strain : fem::Kinematics::solid;
  return find_enclosed_bodies(
      surface, surface, 2, [&] { return sides; }, kinematics, comm);
}

// However deep, and however coarse the outer body is; not in a hollow of it, nor where it sticks out, nor bodies in contact.
TEST(Interpenetration, EnclosedFromTheStart)
{
  OuterFaces skin;
  skin.add_box(0, Point(0, 0, 0), Point(10, 10, 10), {2, 2, 2});
  const auto first = skin.faces.size();
  auto out = skin;
  skin.add_box(1, Point(3, 4, 5), Point(0.2, 0.2, 0.2), {1, 1, 1});
  const auto found = enclosed(skin);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].body, 1);
  EXPECT_EQ(found[0].other, 0);
  EXPECT_NEAR(found[0].depth, 3.2, 1e-12);
  EXPECT_NEAR((found[0].at - Point(3.2, 4.1, 5.1)).norm(), 0, 1e-12);
  ContactSides sides;
  sides.of_face[0] = {0};
  sides.of_face[static_cast<Global>(first)] = {1};
  EXPECT_TRUE(enclosed(skin, sides).empty());
  out.add_box(1, Point(3, 4, 5), Point(0.2, 0.2, 5.2), {1, 1, 1});
  EXPECT_TRUE(enclosed(out).empty());

  OuterFaces plane;
  plane.add_line(0, {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}});
  auto hollow = plane;
  const std::vector<Point> square{{4, 4, 0}, {5, 4, 0}, {5, 5, 0}, {4, 5, 0}};
  plane.add_line(1, square);
  EXPECT_EQ(enclosed(plane).size(), 1u);
  hollow.add_line(0, {{3, 3, 0}, {3, 6, 0}, {6, 6, 0}, {6, 3, 0}});
  hollow.add_line(1, square);
  EXPECT_TRUE(enclosed(hollow).empty());
}

// Bars of one cell across, of which all nodes lie on edges of both: where the other body's surface continues one's own there is
// no way out.
TEST(Interpenetration, BarsOfEqualSection)
{
  OuterFaces skin;
  skin.add_box(0, Point(0, 0, 0), Point(5, 1, 1), {5, 1, 1});
  skin.add_box(1, Point(5.1, 0, 0), Point(5, 1, 1), {5, 1, 1});
  EXPECT_TRUE(moved(skin, Point(-0.1, 0, 0)).empty());
  const auto found = moved(skin, Point(-0.3, 0, 0));
  EXPECT_EQ(found.size(), 18u);  // 4 nodes, the middles of the edges between them, and of the face, from either side
  for (const auto& place : found) EXPECT_NEAR(place.depth, 0.2, 1e-12);
}

// A coating, thinner than a hundredth of the way: its upper side is no continuation of the block's.
TEST(Interpenetration, CoatingOnABlock)
{
  auto skin = block();
  skin.add_box(1, Point(0, 0, 1), Point(1, 1, 0.01), {3, 3, 1});
  EXPECT_TRUE(moved(skin, Point(0, 0, 1.2)).empty());
  EXPECT_TRUE(moved(skin, Point(1.2, 0, 0)).empty());
  EXPECT_TRUE(moved(skin, Point(0, 0, -0.005)).size() > 1);
}

// What overlaps before anything moves: flat faces by more than a hundredth of their size, 0.35.
TEST(Interpenetration, OverlapsFromTheStart)
{
  auto skin = block();
  skin.add_box(1, Point(0.2, 0.2, 0.997), Point(0.5, 0.5, 0.5), {2, 2, 2});
  EXPECT_TRUE(moved(skin, Point(0.1, 0.1, 0)).empty());
  EXPECT_TRUE(moved(skin, Point(0, 0, 0.03)).empty());
  EXPECT_NEAR(deepest(moved(skin, Point(0, 0, -0.1))), 0.103, 1e-12);
  skin = block();
  skin.add_box(1, Point(0.2, 0.2, 0.95), Point(0.5, 0.5, 0.5), {2, 2, 2});
  EXPECT_NEAR(deepest(moved(skin, Point(0, 0, 1e-6))), 0.05, 2e-6);
}

std::vector<Point> polygon(double radius, int faces, bool hole)
{
  std::vector<Point> line;
  for (int i = 0; i < faces; ++i) {
    const double angle = 2 * std::numbers::pi * (hole ? -i : i) / faces;
    line.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return line;
}

// A shaft of many faces and a hole of 8 that cut into it, round a sleeve that contacts hold on both sides: they cannot come
// nearer. Nor does a motion that leaves facets that cross, as far as they do, say that bodies do.
TEST(Interpenetration, RoundASleeve)
{
  OuterFaces skin;
  const auto add = [&](int body, const std::vector<Point>& line) {
    const auto first = static_cast<Global>(skin.faces.size());
    skin.add_line(body, line);
    return std::pair(first, static_cast<Global>(skin.faces.size()));
  };
  add(0, polygon(3, 24, false));
  const auto hole = add(0, polygon(1.02, 8, true)), shaft = add(1, polygon(1, 60, false)),
             outside = add(2, polygon(1.02, 40, false)), inside = add(2, polygon(1, 40, true));
  ContactSides sides, apart;  // contact 0: the shaft and the sleeve, 1: the hole and the sleeve; or another body
  const auto name = [](ContactSides& some, std::pair<Global, Global> faces, int side) {
    for (Global f = faces.first; f < faces.second; ++f) some.of_face[f] = {side};
  };
  name(sides, shaft, 1), name(sides, inside, 0), name(sides, hole, 3), name(sides, outside, 2);
  name(apart, shaft, 1), name(apart, hole, 3);
  const auto cut = 1 - 1.02 * std::cos(std::numbers::pi / 8);
  const auto of_both = [&](const ContactSides& some) {
    auto found = moved(skin, Point(1e-3, 0, 0), some);
    std::erase_if(found, [](const auto& place) { return place.body == 2 || place.other == 2; });
    return found;
  };
  EXPECT_TRUE(of_both(sides).empty());
  EXPECT_NEAR(deepest(of_both(apart)), cut, 2e-3);
}

TEST(Interpenetration, SidesOfAContact)
{
  auto skin = block();
  const auto first = skin.faces.size();
  skin.add_box(1, Point(0.2, 0.2, 1), Point(0.5, 0.5, 0.5), {2, 2, 2});
  ContactSides sides, others;
  for (std::size_t f = 0; f < first; ++f) sides.of_face[static_cast<Global>(f)] = others.of_face[static_cast<Global>(f)] = {4};
  for (std::size_t f = first; f < skin.faces.size(); ++f) {
    sides.of_face[static_cast<Global>(f)] = {3, 5};
    others.of_face[static_cast<Global>(f)] = {3, 6};
  }
  const Point down(0, 0, -0.1);
  EXPECT_TRUE(moved(skin, down, sides).empty());
  EXPECT_NEAR(deepest(moved(skin, down, others)), 0.1, 1e-12);  // sides of two contacts
  EXPECT_NEAR(deepest(moved(skin, down)), 0.1, 1e-12);
}

// Three uneven bars, one of fine and one of coarse cells above a long one, that comes up between them and moves aside. Each rank
// has a piece of every bar, and is told of what lies near those: places and depths are those of one rank, to the last digit.
TEST(Interpenetration, TheSameOnAnyRanks)
{
  constexpr double length = 20;
  OuterFaces skin;
  skin.add_box(0, Point(0, 0, 0), Point(length, 2, 1), {70, 7, 3});
  skin.add_box(1, Point(0.5, 0.3, 1.15), Point(9, 1.4, 1), {43, 6, 2});
  skin.add_box(2, Point(10, -0.2, 1.1), Point(9.5, 2.5, 1), {8, 3, 1});
  for (auto& x : skin.points) x[2] += 0.1 * std::sin(2.3 * x[0] + x[2]) * std::cos(1.7 * x[1]);
  auto after = skin;
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    for (const Local n : skin.faces[f])
      if (skin.body[f] == 0)
        after.points[static_cast<std::size_t>(n)] = skin.points[static_cast<std::size_t>(n)] + Point(0.02, 0, 0.2);
  const auto found_on = [&](const Communicator& comm) {
    return find_interpenetrations(
        skin.in_slabs(length, comm), after.in_slabs(length, comm), 3, [] { return ContactSides(); }, {1e-3, 0.42},
        fem::Kinematics::solid, comm);
  };
  const auto found = found_on(Communicator()), expected = found_on(Communicator(MPI_COMM_SELF));
  EXPECT_GT(std::ranges::count(expected, 1, &Interpenetration::body), 20);
  EXPECT_GT(std::ranges::count(expected, 2, &Interpenetration::other), 20);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].body, expected[i].body);
    EXPECT_EQ(found[i].other, expected[i].other);
    EXPECT_EQ(found[i].depth, expected[i].depth);
    EXPECT_EQ(found[i].at, expected[i].at);
  }
}

// A block in a pit between two walls, 0.2 from each: within the body's box, and not in the body.
TEST(Interpenetration, InAPit)
{
  OuterFaces skin;
  skin.add_line(0, {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}});
  skin.add_line(1, {{1.2, 1, 0}, {1.8, 1, 0}, {1.8, 1.7, 0}, {1.2, 1.7, 0}});
  EXPECT_TRUE(moved(skin, Point(0.15, 0, 0)).empty());
  EXPECT_TRUE(moved(skin, Point(0.1, 0.5, 0)).empty());
  EXPECT_NEAR(deepest(moved(skin, Point(0.5, 0, 0))), 0.3, 1e-12);
}

// A square on its corner comes down onto a block's face, and beside the block's corner.
TEST(Interpenetration, CornerInAPlane)
{
  OuterFaces skin;
  skin.add_line(0, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  skin.add_line(1, {{1.5, 1.1, 0}, {2.5, 2.1, 0}, {1.5, 3.1, 0}, {0.5, 2.1, 0}});
  EXPECT_TRUE(moved(skin, Point(0, -0.1, 0)).empty());
  auto found = moved(skin, Point(0, -0.4, 0));
  ASSERT_FALSE(found.empty());
  const auto corner = deepest_of(found);
  EXPECT_EQ(corner.body, 1);
  EXPECT_NEAR(corner.depth, 0.3, 1e-12);
  EXPECT_EQ(corner.at, Point(1.5, 1.1, 0));
  found = moved(skin, Point(0.45, -0.3, 0));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].at, Point(2, 1, 0));  // the block's
  EXPECT_NEAR(found[0].depth, 0.15 / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(found[1].depth, 0.05, 1e-12);
}

}  // namespace
}  // namespace mortise::contact
