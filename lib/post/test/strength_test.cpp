// Contacts that press on few faces, or at single nodes, from both sides of their limits. The same on any ranks.
#include "post/strength.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "testing/cut.hpp"

namespace mortise::post {
namespace {

// A side of 8 x 8 faces of size 1, in four subdomains, and one below it of `below` x `below`.
struct Sides {
  Communicator comm;
  partition::Decomposition decomposition;
  std::vector<contact::Pair> pairs{1};

  explicit Sides(const std::string& element = "hex8", int below = 4)
  {
    mesh::Options mesh;
    mesh.blocks["lower"] = {{0, 0, -1}, {8, 8, 1}, {below, below, 1}, element};
    mesh.blocks["upper"] = {{0, 0, 0}, {8, 8, 1}, {8, 8, 1}, element};
    partition::Options options;
    options.method = "grid";
    options.counts = {{"lower", {1, 1, 1}}, {"upper", {2, 2, 1}}};
    decomposition = partition::cut_of(mesh, options, comm);
    pairs[0].options.name = "joint";
    pairs[0].options.secondary = "upper.zmin";
    pairs[0].secondary = partition::side_of(decomposition, "upper.zmin");
    pairs[0].primary = std::make_shared<const mesh::Surface>(partition::side_of(decomposition, "lower.zmax"));
  }

  // Pressures at nodes, `mean` times that as a mean over faces.
  std::vector<contact::SurfaceState> state(const std::function<double(const Point&)>& pressure, double mean = 1) const
  {
    contact::SurfaceState state;
    for (const auto& x : pairs[0].secondary.points) {
      const double p = pressure(x);
      state.pressure.push_back(p);
      state.recovered_pressure.push_back(mean * p);
      state.status.push_back(p > 0 ? 2 : 0);
      state.near.push_back(1);
      state.without_rows.push_back(0);
    }
    return {state};
  }
};

// Pressed with 5 for 2 <= x, y <= 2 + width, most in the middle.
double in_square(const Point& x, double width)
{
  const double middle = 2 + width / 2;
  const double off = std::max(std::abs(x[0] - middle), std::abs(x[1] - middle));
  return off > width / 2 + 1e-9 ? 0.0 : 5 - 0.1 * off;
}

TEST(NarrowContacts, AreNarrowerThanThreeFaces)
{
  const Sides sides, curved("hex20");
  const auto found = [](const Sides& on, double width, double mean) {
    return narrow_contacts(on.state([&](const Point& x) { return in_square(x, width); }, mean), {}, on.pairs, 0, on.comm);
  };
  const auto at_one_node = found(sides, 0, 1);
  ASSERT_EQ(at_one_node.size(), 1U);
  EXPECT_EQ(at_one_node[0].kind, "narrow_contact");
  EXPECT_EQ(at_one_node[0].contact, "joint");
  EXPECT_EQ(at_one_node[0].boundary, "upper.zmin");
  EXPECT_EQ(at_one_node[0].value, 0);
  EXPECT_LT((*at_one_node[0].at - Point(2, 2, 0)).norm(), 1e-12);
  EXPECT_NE(at_one_node[0].text.find("on no whole face"), std::string::npos);

  // On one face of first order whatever the mean; else where the mean lost a sixth.
  ASSERT_EQ(found(sides, 1, 1).size(), 1U);
  EXPECT_EQ(found(sides, 1, 1)[0].value, 1);
  EXPECT_TRUE(found(curved, 1, 0.84).empty());
  EXPECT_EQ(found(curved, 1, 0.82).size(), 1U);
  for (const auto* on : {&sides, &curved}) {
    EXPECT_TRUE(found(*on, 2, 0.84).empty());
    const auto two = found(*on, 2, 0.82);
    ASSERT_EQ(two.size(), 1U);
    EXPECT_EQ(two[0].value, 2);
    EXPECT_NE(two[0].text.find("two faces"), std::string::npos) << two[0].text;
    EXPECT_LT((*two[0].at - Point(3, 3, 0)).norm(), 1e-12);
    EXPECT_TRUE(found(*on, 3, 0.5).empty());
    EXPECT_TRUE(found(*on, -1, 1).empty());  // nothing presses
  }

  // What ends at the side's own border is not ended by a gap.
  EXPECT_TRUE(narrow_contacts(sides.state([](const Point&) { return 5; }, 0.5), {}, sides.pairs, 0, sides.comm).empty());
  auto bonded = sides.pairs;
  bonded[0].options.law = contact::Law::bonded;
  const auto one = sides.state([](const Point& x) { return in_square(x, 0); });
  EXPECT_TRUE(narrow_contacts(one, {}, bonded, 0, sides.comm).empty());
}

// A corner without rows shows what its neighbours have, and is pressed if all nodes with rows of its face are.
TEST(NarrowContacts, CornersWithoutRowsGoWithTheOthersOfAFace)
{
  const Sides sides;
  auto state = sides.state([](const Point& x) { return in_square(x, 1); });
  const auto wide = [&](const Point& bare) {
    for (std::size_t i = 0; i < state[0].status.size(); ++i)
      state[0].without_rows[i] = (sides.pairs[0].secondary.points[i] - bare).norm() < 1e-9;
    const auto found = narrow_contacts(state, {}, sides.pairs, 0, sides.comm);
    return found.size() == 1 ? found[0].value : -1;
  };
  EXPECT_EQ(wide({2, 2, 0}), 1);                            // of the one face that is pressed
  for (std::size_t i = 0; i < state[0].status.size(); ++i)  // the corner opposite opens
    if ((sides.pairs[0].secondary.points[i] - Point(3, 3, 0)).norm() < 1e-9) state[0].status[i] = 0;
  EXPECT_EQ(wide({2, 2, 0}), 0);
  EXPECT_EQ(wide({3, 3, 0}), 0);  // open, and without rows: no corner that is pressed
}

// Where more than half of the force acts between nodes, the contact is narrower than a face whatever nodes show.
TEST(NarrowContacts, MayActBetweenNodes)
{
  const Sides sides;
  const auto wide = sides.state([](const Point& x) { return in_square(x, 4); });
  const auto& status = wide[0].status;
  const auto pressed = std::find_if(status.begin(), status.end(), [](int of_node) { return of_node != 0; }) - status.begin();
  const auto with = [&](double between_nodes) {
    std::vector<contact::ContactNodeState> points(2);
    if (pressed == std::ssize(status)) return narrow_contacts(wide, {}, sides.pairs, 0, sides.comm);
    for (auto& point : points) point.node = sides.pairs[0].secondary.node_id[static_cast<std::size_t>(pressed)];
    points[0].parts.push_back({points[0].node, 1, Point(0, 0, 1)});
    points[0].force = between_nodes;
    points[1].force = 1;
    return narrow_contacts(wide, points, sides.pairs, 0, sides.comm);
  };
  EXPECT_TRUE(with(0.9).empty());
  const auto found = with(1.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 0);
}

TEST(ScatteredContacts, PressAtSingleNodesOfAStiffSide)
{
  const auto found = [](const Sides& sides, const std::function<double(const Point&)>& pressure, double stiffer) {
    return scattered_contacts(sides.state(pressure), sides.pairs, {1000, 1000 * stiffer}, sides.comm);
  };
  // At every second node each way: one corner of each of 64 faces.
  const auto scattered = [](const Point& x) {
    return std::lround(x[0]) % 2 == 0 && std::lround(x[1]) % 2 == 0 ? 1 + x[0] + 0.1 * x[1] : 0.0;
  };
  const Sides sides, as_fine("hex8", 8);
  const auto many = found(sides, scattered, 4.1);
  ASSERT_EQ(many.size(), 1U);
  EXPECT_EQ(many[0].kind, "scattered_contact");
  EXPECT_EQ(many[0].contact, "joint");
  EXPECT_EQ(many[0].value, 64);
  EXPECT_EQ(many[0].limit, 0);
  EXPECT_LT((*many[0].at - Point(8, 8, 0)).norm(), 1e-12);
  EXPECT_TRUE(found(sides, scattered, 3.9).empty());
  EXPECT_TRUE(found(as_fine, scattered, 4.1).empty());

  const auto at_nodes = [](int count) {
    return [count](const Point& x) {
      return std::abs(x[1] - 4) < 1e-9 && std::lround(x[0]) % 2 == 1 && x[0] < 2 * count ? 1.0 : 0.0;
    };
  };
  EXPECT_TRUE(found(sides, at_nodes(1), 5).empty());  // four faces
  EXPECT_EQ(found(sides, at_nodes(2), 5).size(), 1U);
  // Beside columns of 8 whole faces.
  const auto beside = [&](int columns) {
    return [=](const Point& x) { return x[0] < columns + 1e-9 ? 1.0 : x[0] > columns + 1.1 ? scattered(x) : 0.0; };
  };
  EXPECT_EQ(found(sides, beside(1), 5).size(), 1U);  // 8 whole and 56 others
  EXPECT_TRUE(found(sides, beside(4), 5).empty());   // 32 whole and 32 others
  EXPECT_TRUE(found(
                  sides, [](const Point&) { return 1.0; }, 5)
                  .empty());

  // Nodes without rows show what their neighbours have: alone they are not pressed.
  auto bare = sides.state(scattered);
  for (std::size_t i = 0; i < bare[0].status.size(); ++i) bare[0].without_rows[i] = bare[0].status[i] != 0;
  EXPECT_TRUE(scattered_contacts(bare, sides.pairs, {1000, 5000}, sides.comm).empty());

  for (const bool obstacle : {false, true}) {
    Sides others;
    if (obstacle)
      others.pairs[0].primary.reset();
    else
      others.pairs[0].options.law = contact::Law::bonded;
    EXPECT_TRUE(found(others, scattered, 5).empty());
  }
}

TEST(LargestTensions, AreForcesOverAreas)
{
  const Communicator comm;
  std::vector<contact::ContactNodeState> points(4);
  for (auto& p : points) {
    p.contact = 1;
    p.status = contact::Status::stick;
    p.area = 0.5;
  }
  points[0].force = 8;
  points[1].force = -2 - comm.rank();
  points[2].force = -90;
  points[2].status = contact::Status::open;
  points[3].force = -90;
  points[3].area = 0;
  EXPECT_EQ(largest_tensions(points, 2, comm), (std::vector<double>{0, 4 + 2.0 * (comm.size() - 1)}));
}

}  // namespace
}  // namespace mortise::post
