#include "mesh/instances.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "base/error.hpp"
#include "mesh/blocks.hpp"

namespace mortise::mesh {
namespace {

InstanceOptions rotation(double angle, std::array<double, 3> center = {0, 0, 0}, std::optional<int> count = {})
{
  InstanceOptions entry;
  entry.count = count;
  entry.rotate = RotationOptions{{0, 0, 2}, angle, center};
  return entry;
}

TEST(Motions, TurnFirstThenMove)
{
  auto entry = rotation(90, {1, 0, 0});
  entry.translate = {0, 0, 5};
  const auto all = motions({entry});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_LT((all[0](Point(3, 0, 0)) - Point(1, 2, 5)).norm(), 1e-14);
}

TEST(Motions, ARowStartsWhereThePartLies)
{
  const auto all = motions({rotation(360.0 / 35, {2, -1, 0}, 35)});
  ASSERT_EQ(all.size(), 35U);
  for (int k = 0; k < 35; ++k) {
    const double a = 2 * std::numbers::pi * k / 35;
    const Point expected(2 + 3 * std::cos(a), -1 + 3 * std::sin(a), 7);
    EXPECT_LT((all[static_cast<std::size_t>(k)](Point(5, -1, 7)) - expected).norm(), 1e-14) << k;
  }
}

TEST(Motions, AScrewIsAppliedAgainAndAgain)
{
  auto entry = rotation(30, {1, 2, 0}, 8);
  entry.translate = {0.5, 0, 1};
  const auto all = motions({entry});
  auto once = entry;
  once.count.reset();
  const auto step = motions({once})[0];
  Motion expected;
  for (const auto& motion : all) {
    EXPECT_LT((motion.rotation - expected.rotation).norm(), 1e-14);
    EXPECT_LT((motion.translation - expected.translation).norm(), 1e-13);
    expected = compose(step, expected);
  }
}

TEST(Motions, RowsOfRows)
{
  InstanceOptions along;
  along.count = 2;
  along.translate = {0, 0, 10};
  along.of = {rotation(120, {0, 0, 0}, 3)};
  const auto all = motions({along});
  ASSERT_EQ(all.size(), 6U);
  const double h = std::sqrt(3) / 2;
  EXPECT_LT((all[2](Point(1, 0, 0)) - Point(-0.5, -h, 0)).norm(), 1e-14);
  EXPECT_LT((all[4](Point(1, 0, 0)) - Point(-0.5, h, 10)).norm(), 1e-14);
}

TEST(Motions, CoincidingCopiesAreFound)
{
  EXPECT_FALSE(coinciding(motions({rotation(90, {1, 1, 0}, 4)})));
  const auto found = coinciding(motions({rotation(90, {1, 1, 0}, 5)}));
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, std::pair(std::size_t{0}, std::size_t{4}));
}

// Parts "pin" (two bodies) and "plate" with boundaries surface (both), pin_end, plate_top.
Layout pins(const std::vector<std::string>& boundaries = {"surface", "pin_end", "plate_top"})
{
  Catalogue parts;
  parts.bodies = {{"pin.1", "pin"}, {"pin.2", "pin"}, {"plate", "plate"}};
  parts.boundaries = boundaries;
  return lay_out(parts, {{"pin", std::vector<Motion>(2)}}, {0, 10, 30, 60}, {0, 4, 9, 20}, {{0, 0}, {0, 2}, {1, 1}, {2, 2}});
}

TEST(Layout, NamesOfInstances)
{
  const auto layout = pins();
  std::vector<std::string> names;
  for (const auto& body : layout.catalogue.bodies) names.push_back(body.name + "/" + body.group + "/" + body.instance);
  EXPECT_EQ(names, (std::vector<std::string>{"pin.1.1/pin/pin.1", "pin.1.2/pin/pin.1", "pin.2.1/pin/pin.2", "pin.2.2/pin/pin.2",
                                             "plate/plate/"}));
  EXPECT_EQ(layout.catalogue.boundaries, (std::vector<std::string>{"surface", "pin_end", "plate_top", "pin.1.surface",
                                                                   "pin.1.end", "pin.2.surface", "pin.2.end"}));
  EXPECT_EQ(layout.catalogue.node_count, 90);
  EXPECT_EQ(layout.catalogue.cell_count, 29);
  EXPECT_EQ(layout.bodies[3].part, 1);
  EXPECT_EQ(layout.bodies[3].node_shift, 40 - 10 + 0);
  EXPECT_EQ(layout.bodies[4].node_shift, 60 - 30);
  EXPECT_FALSE(layout.bodies[4].motion);
}

TEST(Layout, NamesThatAreTaken)
{
  // pin_end and "end" would both be pin.1.end: the second keeps its whole name.
  Catalogue parts;
  parts.bodies = {{"pin", "pin"}};
  parts.boundaries = {"end", "pin_end"};
  const std::map<std::string, std::vector<Motion>> two{{"pin", std::vector<Motion>(2)}};
  EXPECT_EQ(lay_out(parts, two, {0, 1}, {0, 1}, {{0, 0}, {1, 0}}).catalogue.boundaries,
            (std::vector<std::string>{"end", "pin_end", "pin.1.end", "pin.1.pin_end", "pin.2.end", "pin.2.pin_end"}));
  parts.bodies.push_back({"pin.2", "pin.2"});
  EXPECT_THROW(lay_out(parts, two, {0, 1, 2}, {0, 1, 2}, {}), Error);
  parts.bodies.pop_back();
  parts.boundaries = {"end", "pin.2.end"};
  EXPECT_THROW(lay_out(parts, two, {0, 1}, {0, 1}, {{0, 0}}), Error);
}

TEST(Place, MovesAndNumbers)
{
  Options options;
  BlockOptions block;
  block.cells = {2, 1, 1};
  options.blocks["pad"] = block;
  const auto piece = generate(options, 3, 0, {0, 0, 0}, {2, 1, 1});
  PartInstance instance{0, motions({rotation(90)})[0], 100, 50, std::vector<int>(6, -1)};
  instance.own_boundary[3] = 17;
  const auto moved_piece = instantiate(piece, instance, 4);
  EXPECT_EQ(moved_piece.node_id[0], piece.node_id[0] + 100);
  EXPECT_EQ(moved_piece.cell_id[1], piece.cell_id[1] + 50);
  EXPECT_EQ(moved_piece.cell_body, (std::vector<int>{4, 4}));
  for (std::size_t n = 0; n < piece.node_count(); ++n) {
    const Point x = piece.points[n];
    EXPECT_LT((moved_piece.points[n] - Point(-x[1], x[0], x[2])).norm(), 1e-15);
  }
  ASSERT_EQ(moved_piece.facets.cells.size(), piece.facets.cells.size() + 2);  // of the side ymax
  EXPECT_EQ(moved_piece.facets.boundary.back(), 17);
  EXPECT_EQ(moved_piece.facets.parent.size(), moved_piece.facets.boundary.size());
}

}  // namespace
}  // namespace mortise::mesh
