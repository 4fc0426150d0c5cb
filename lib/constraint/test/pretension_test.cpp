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
  contacts.nodes.push_back({1, 7, 2, Point(-0.6, 0, 0.8), {}, 4});
  for (int r = 0; r < 5; ++r) contacts.rows.close(0);
  contacts.bonded.assign(3, true);
  return contacts;
}

TEST(Cuts, ARowsPartIsWhatItSeesOfTheMeanNormal)
{
  const Communicator comm;
  const auto pretension_sections = find_pretension_sections(tilted_points(), std::vector<Preload>{{1, "bolt", 3.0}}, false, comm);
  ASSERT_EQ(pretension_sections.size(), 1U);
  EXPECT_LT((pretension_sections[0].normal - Point(0, 0, 1)).norm(), 1e-14);
  ASSERT_EQ(pretension_sections[0].rows.size(), 4U);
  const std::vector<double> parts{1.5 * 0.8, -1.5 * 0.6, 0, 0.8};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(pretension_sections[0].rows[i].row, i + 1);
    EXPECT_NEAR(pretension_sections[0].rows[i].part, parts[i], 1e-14);
  }
}

TEST(Cuts, InAxisymmetryTheDirectionIsTheAxis)
{
  Contacts contacts = tilted_points();
  contacts.nodes[0].normal = Point(0.8, -0.6, 0);
  const auto pretension_sections =
      find_pretension_sections(contacts, std::vector<Preload>{{0, "bolt", 3.0}}, true, Communicator());
  EXPECT_LT((pretension_sections[0].normal - Point(0, -1, 0)).norm(), 1e-14);
}

void expect_error(Contacts contacts, int contact, const std::string& text)
{
  try {
    find_pretension_sections(contacts, std::vector<Preload>{{contact, "bolt", 3.0}}, false, Communicator());
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
