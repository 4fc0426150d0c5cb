#include "constraint/pretension.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace mortise::constraint {
namespace {

// Points of contact 1 on every rank, two with tilted normals whose mean is z, one on an axis of its own; contact 0 looks
// elsewhere.
Contacts tilted_points()
{
  Contacts contacts;
  contacts.nodes.push_back({0, 5, 7, Point(1, 0, 0), {}, 0});
  contacts.nodes.push_back({1, 6, 2, Point(0.6, 0, 0.8), {Point(0.8, 0, -0.6), Point(0, 1, 0)}, 1, 1.5});
  contacts.nodes.push_back({1, 7, 2, Point(-0.6, 0, 0.8), {Point(0.8, 0, 0.6), Point(0, 1, 0)}, 4});
  for (int r = 0; r < 7; ++r) contacts.rows.close(0);
  contacts.bonded.assign(3, true);
  return contacts;
}

TEST(Cuts, ARowsPartIsWhatItSeesOfTheMeanNormal)
{
  const Communicator comm;
  const auto pretension_sections = find_pretension_sections(tilted_points(), std::vector<Preload>{{1, "bolt", 3.0}}, 3, {}, comm);
  ASSERT_EQ(pretension_sections.size(), 1U);
  EXPECT_LT((pretension_sections[0].normal - Point(0, 0, 1)).norm(), 1e-14);
  ASSERT_EQ(pretension_sections[0].rows.size(), 6U);
  const std::vector<double> parts{1.5 * 0.8, -1.5 * 0.6, 0, 0.8, 0.6, 0};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(pretension_sections[0].rows[i].row, i + 1);
    EXPECT_NEAR(pretension_sections[0].rows[i].part, parts[i], 1e-14);
  }
}

TEST(Cuts, OnAnAxisTheDirectionIsTheAxis)
{
  Contacts contacts = tilted_points();
  contacts.nodes[0].normal = Point(0.8, -0.6, 0);
  const auto pretension_sections = find_pretension_sections(
      contacts, std::vector<Preload>{{0, "bolt", 3.0}}, 2, [](const Preload&) { return Point(0, 1, 0); }, Communicator());
  EXPECT_LT((pretension_sections[0].normal - Point(0, -1, 0)).norm(), 1e-14);
}

// Half of a bolt, whose rows feel nothing along the plane of symmetry's normal: what its normals have of that counts for nothing.
// What a support holds of one side alone does, since the other moves.
TEST(Cuts, TheDirectionLiesInPlanesOfSymmetry)
{
  const auto direction = [](const std::vector<Point>& tangents) {
    Contacts contacts;
    contacts.nodes.push_back({0, 6, 2, Point(0.6, 0, 0.8), tangents, 0});
    const auto feel = [&](int component, double coefficient) { contacts.rows.entries.push_back({6, component, coefficient}); };
    feel(2, 0.8);
    contacts.rows.close(0);
    feel(1, 1);
    contacts.rows.close(0);
    for (std::size_t r = 2; r < 1 + tangents.size(); ++r) contacts.rows.close(0);  // of the primary side
    contacts.bonded.assign(1, true);
    return find_pretension_sections(contacts, std::vector<Preload>{{0, "bolt", 3.0}}, 3, {}, Communicator())[0].normal;
  };
  EXPECT_LT((direction({Point(0, 1, 0)}) - Point(0, 0, 1)).norm(), 1e-14);
  EXPECT_LT((direction({Point(0, 1, 0), Point(0.8, 0, -0.6)}) - Point(0.6, 0, 0.8)).norm(), 1e-14);
}

void expect_error(Contacts contacts, int contact, const std::string& text)
{
  try {
    find_pretension_sections(contacts, std::vector<Preload>{{contact, "bolt", 3.0}}, 3, {}, Communicator());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    EXPECT_NE(std::string(error.what()).find("contact \"bolt\": " + text), std::string::npos) << error.what();
  }
}

TEST(Cuts, NeedADirection)
{
  expect_error(tilted_points(), 2, "the two sides of its pretension section do not meet");
  Contacts closed = tilted_points();
  closed.nodes[2].normal = -closed.nodes[1].normal;
  expect_error(closed, 1, "the normals of its pretension section point all ways");
}

}  // namespace
}  // namespace mortise::constraint
