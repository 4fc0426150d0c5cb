// Which bodies face each other, on skins of boxes and of bodies in a plane. Counts and gaps follow from the drawings.
#include "contact/pairing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "outer_faces.hpp"

namespace mortise::contact {
namespace {

// Faces that are searched for pairs.
struct Searched : OuterFaces {
  std::vector<ContactCandidate> candidates(const Options& options = {}, const std::set<Bodies>& known = {}) const
  {
    const Communicator comm;
    const int bodies = 1 + *std::max_element(body.begin(), body.end());
    return find_contact_candidates(on_rank(comm), bodies, known, options,
                                   faces[0].size() == 2 ? fem::Kinematics::plane_strain : fem::Kinematics::solid, comm);
  }
};

// A block of 2 x 2 x 2 cells and on it, `gap` higher, one of 4 x 4 x 4.
Searched two_blocks(double gap)
{
  Searched skin;
  skin.add_box(0, Point(0, 0, 0), Point(1, 1, 1), {2, 2, 2});
  skin.add_box(1, Point(0, 0, 1 + gap), Point(1, 1, 1), {4, 4, 4});
  return skin;
}

Options within(double distance)
{
  Options options;
  options.search_distance = distance;
  return options;
}

TEST(Pairing, TwoBlocks)
{
  const auto skin = two_blocks(0.05);
  const auto found = skin.candidates();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].secondary, 1);  // the finer one
  EXPECT_EQ(found[0].primary, 0);
  EXPECT_EQ(found[0].patch, 0);
  EXPECT_EQ(found[0].secondary_facing, 16);
  EXPECT_EQ(found[0].primary_facing, 4);
  EXPECT_EQ(found[0].secondary_faces.size(), 16u);  // no further than the edges
  EXPECT_EQ(found[0].primary_faces.size(), 4u);
  for (const Global f : found[0].primary_faces)
    for (const Local n : skin.faces[static_cast<std::size_t>(f)]) EXPECT_EQ(skin.points[static_cast<std::size_t>(n)][2], 1);
  EXPECT_NEAR(found[0].area, 1, 1e-14);
  EXPECT_NEAR(found[0].least_gap, 0.05, 1e-14);
  EXPECT_NEAR(found[0].largest_gap, 0.05, 1e-14);
  EXPECT_NEAR(found[0].reach, 0.5 * std::sqrt(2), 1e-14);  // the largest face
}

// Half of the smaller faces' diagonal of 0.35, either way, where the deck says nothing.
TEST(Pairing, Distance)
{
  for (const double gap : {-0.2, -0.17, 0.17, 0.2}) {
    const auto found = two_blocks(gap).candidates();
    ASSERT_EQ(found.size(), std::abs(gap) < 0.1767 ? 1u : 0u) << gap;
    for (const auto& candidate : found) EXPECT_NEAR(candidate.least_gap, gap, 1e-14);
  }
  EXPECT_EQ(two_blocks(0.5).candidates(within(0.6)).size(), 1u);
  EXPECT_EQ(two_blocks(-0.5).candidates(within(0.6)).size(), 1u);
  EXPECT_EQ(two_blocks(0.5).candidates(within(0.4)).size(), 0u);
  EXPECT_EQ(two_blocks(0.5).candidates(within(0.6), {{0, 1}}).size(), 0u);
  EXPECT_EQ(two_blocks(0.5).candidates(within(0.6))[0].reach, 0.6);
}

TEST(Pairing, GapsThatInterferenceCloses)
{
  Options options;
  options.interference = 0.4;
  EXPECT_EQ(two_blocks(0.5).candidates(options).size(), 1u);
  EXPECT_EQ(two_blocks(-0.5).candidates(options).size(), 0u);
  options.interference = -0.4;
  EXPECT_EQ(two_blocks(0.5).candidates(options).size(), 0u);
  EXPECT_EQ(two_blocks(-0.5).candidates(options).size(), 1u);
}

// Plates much thinner than their faces are long: next ones meet, those beyond do not, nor do far sides, be the plates apart or
// overlapping a little.
TEST(Pairing, ThinPlates)
{
  for (const double gap : {-0.005, 0.0, 0.01}) {
    Searched skin;
    for (int i = 0; i < 4; ++i) skin.add_box(i, Point(0.03 * i, 0, (0.05 + gap) * i), Point(1, 1, 0.05), {4, 4, 1});
    const auto found = skin.candidates();
    ASSERT_EQ(found.size(), 3u) << gap;
    for (int i = 0; i < 3; ++i) {
      const auto& candidate = found[static_cast<std::size_t>(i)];
      EXPECT_EQ(candidate.secondary, i);  // equal in all, so the lower number
      EXPECT_EQ(candidate.primary, i + 1);
      EXPECT_NEAR(candidate.least_gap, gap, 1e-14);
      EXPECT_NEAR(candidate.largest_gap, gap, 1e-14);
      EXPECT_EQ(candidate.secondary_faces.size(), 16u);
      EXPECT_EQ(candidate.primary_faces.size(), 16u);
    }
  }
}

TEST(Pairing, TwoPatchesAreTwoContacts)
{
  Searched skin;  // a beam on two feet, with a pit between them
  skin.add_box(0, Point(0, 0, 0), Point(1, 1, 1), {3, 3, 2});
  skin.add_box(0, Point(4, 0, 0), Point(1, 1, 1), {3, 3, 2});
  skin.add_box(1, Point(0, 0, 1), Point(1, 1, 1), {2, 2, 2});
  skin.add_box(1, Point(4, 0, 1), Point(1, 1, 1), {2, 2, 2});
  const auto found = skin.candidates();
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found[i].patch, static_cast<int>(i) + 1);
    EXPECT_EQ(found[i].secondary, 0);
    EXPECT_EQ(found[i].secondary_faces.size(), 9u);
    EXPECT_EQ(found[i].primary_faces.size(), 4u);
  }
}

// A plate with round ends: its outline is smooth all the way round, but its patch does not reach the far side.
std::vector<Point> plate(double y)
{
  constexpr double thickness = 0.1;
  std::vector<Point> line;
  for (int i = 0; i < 8; ++i) line.emplace_back(-1 + 0.25 * i, y, 0);
  for (int end = 0; end < 2; ++end) {
    for (int i = 0; i < 8; ++i) {
      const double angle = std::numbers::pi * (i / 8.0 - 0.5);
      const Point arc = 0.5 * thickness * Point(std::cos(angle), std::sin(angle), 0);
      line.push_back(Point(0, y + 0.5 * thickness, 0) + (end == 0 ? 1 : -1) * (Point(1, 0, 0) + arc));
    }
    for (int i = 0; i < 8 && end == 0; ++i) line.emplace_back(1 - 0.25 * i, y + thickness, 0);
  }
  return line;
}

TEST(Pairing, FarSidesOfRoundedPlates)
{
  Searched skin;
  skin.add_line(0, plate(0));
  skin.add_line(1, plate(0.1));
  const auto found = skin.candidates();
  ASSERT_EQ(found.size(), 1u);
  const auto middle = [&](Global f) {
    const auto& face = skin.faces[static_cast<std::size_t>(f)];
    return Point(0.5 * (skin.points[static_cast<std::size_t>(face[0])] + skin.points[static_cast<std::size_t>(face[1])]));
  };
  for (const auto* side : {&found[0].secondary_faces, &found[0].primary_faces}) {
    int flat = 0;
    for (const Global f : *side)
      if (std::abs(middle(f)[0]) < 0.9) {
        ++flat;
        EXPECT_NEAR(middle(f)[1], 0.1, 1e-12);
      }
    EXPECT_EQ(flat, 8);
  }
  EXPECT_NEAR(found[0].area, 2, 0.2);
}

std::vector<Point> circle(double x, double y, double radius, int n, bool hole = false)
{
  std::vector<Point> line;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * (hole ? -i : i) / n;
    line.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle), 0);
  }
  return line;
}

// A roller on a table: few faces face each other, the patches have room for a zone of contact, and of two equally fine sides the
// flat one is the secondary one.
TEST(Pairing, RollerOnTable)
{
  constexpr double h = 0.1;
  Searched skin;
  skin.add_line(0, circle(0, 1, 1, 64));  // sides of 0.098
  std::vector<Point> table;
  for (int i = 0; i < 40; ++i) table.emplace_back(2 - h * i, 0, 0);
  table.insert(table.end(), {Point(-2, 0, 0), Point(-2, -1, 0), Point(2, -1, 0)});
  skin.add_line(1, table);
  const auto found = skin.candidates();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].secondary, 1);
  EXPECT_EQ(found[0].primary, 0);
  // Gaps up to h / 2 are x <= sqrt(h) = 0.31 from the middle.
  EXPECT_NEAR(static_cast<double>(found[0].secondary_facing), 2 * std::sqrt(h) / h, 3);
  EXPECT_NEAR(found[0].least_gap, 0, 0.0012 + 1e-12);  // a facet's sagitta
  EXPECT_LE(found[0].largest_gap, 0.5 * h);
  // What is within reach must be there, with six faces round it.
  double left = 0;
  for (const Global f : found[0].secondary_faces)
    for (const Local n : skin.faces[static_cast<std::size_t>(f)]) {
      left = std::min(left, skin.points[static_cast<std::size_t>(n)][0]);
      EXPECT_EQ(skin.points[static_cast<std::size_t>(n)][1], 0);
    }
  EXPECT_GE(found[0].reach, h);
  EXPECT_LE(left, -std::sqrt(2 * found[0].reach) - 6 * h);
}

// Rollers between two rings: every roller meets both rings, and no other roller.
TEST(Pairing, RingOfRollers)
{
  constexpr int rollers = 12;
  Searched skin;
  skin.add_line(0, circle(0, 0, 2, 120));       // the inner ring
  skin.add_line(0, circle(0, 0, 1, 60, true));  // its bore
  skin.add_line(1, circle(0, 0, 2.8, 180, true));
  skin.add_line(1, circle(0, 0, 3.5, 180));
  for (int i = 0; i < rollers; ++i) {
    const double angle = 2 * std::numbers::pi * i / rollers;
    skin.add_line(2 + i, circle(2.4 * std::cos(angle), 2.4 * std::sin(angle), 0.4, 40));
  }
  const auto found = skin.candidates();
  ASSERT_EQ(found.size(), 2u * rollers);
  std::set<std::pair<int, int>> pairs;
  for (const auto& candidate : found) {
    EXPECT_GE(candidate.secondary, 2);  // the finer ones
    EXPECT_LE(candidate.primary, 1);
    EXPECT_EQ(candidate.patch, 0);
    pairs.emplace(candidate.secondary, candidate.primary);
    EXPECT_LT(candidate.primary_faces.size(), 90u);  // not all of the raceway
  }
  EXPECT_EQ(pairs.size(), 2u * rollers);
}

// A shim between two blocks hides them from each other, though they are near enough.
TEST(Pairing, ShimHidesWhatIsBehind)
{
  Searched skin = two_blocks(0.01);
  skin.add_box(2, Point(0, 0, 1), Point(1, 1, 0.01), {3, 3, 1});
  const auto found = skin.candidates();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(std::max(found[0].secondary, found[0].primary), 2);
  EXPECT_EQ(std::max(found[1].secondary, found[1].primary), 2);
}

TEST(Pairing, BondedReachesNoFurtherThanWhatIsFound)
{
  auto options = within(0);
  options.law = Law::bonded;
  EXPECT_NEAR(two_blocks(0).candidates(options)[0].reach, 0.5 * 0.25 * std::sqrt(2), 1e-14);
}

}  // namespace
}  // namespace mortise::contact
