// What is read on surfaces: pressures, slip and status, and how far bodies are from each other.
#include "contact/state.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/proximity.hpp"
#include "surfaces.hpp"

namespace mortise::contact {
namespace {

TEST(Proximity, DistanceOfFacesNotOfNodes)
{
  const Communicator comm;
  const auto at = [](double z) { return [z](double x, double y) { return Point(x, y, z); }; };
  auto skin = surface({1, 1, 0, 1, 0, 1, true}, at(0), comm);
  const auto add = [&](const mesh::Surface& other, int body) {
    const auto base = static_cast<Local>(skin.points.size());
    skin.points.insert(skin.points.end(), other.points.begin(), other.points.end());
    skin.node_id.insert(skin.node_id.end(), other.node_id.begin(), other.node_id.end());
    for (std::size_t f = 0; f < other.faces.size(); ++f) {
      std::vector<Local> nodes;
      for (const Local n : other.faces[f]) nodes.push_back(base + n);
      skin.faces.add(other.faces.type[f], nodes);
      skin.face_id.push_back(other.face_id[f]);
      skin.body.push_back(body);
    }
  };
  add(surface({2, 2, 0.4, 0.6, 0.4, 0.6, false, true, primary_ids}, at(0.25), comm), 1);
  add(surface({2, 2, 3, 4, 0, 1, false, true, 2 * primary_ids}, at(0), comm), 2);
  const auto found = nearest_bodies(skin, {true, false, true}, comm);
  EXPECT_EQ(found[0].body, 1);
  EXPECT_NEAR(found[0].distance, 0.25, 1e-14);
  EXPECT_EQ(found[1].body, -1);
  EXPECT_EQ(found[2].body, 0);
  EXPECT_NEAR(found[2].distance, 2, 1e-14);
}

TEST(State, SumsAndStatus)
{
  const Communicator comm;
  constraint::ContactNode point{0, 7, 0.5, Point(0, 0, 1), {Point(1, 0, 0), Point(0, 1, 0)}, 0};
  const auto slip = state_of(point, false, std::vector<double>{10, 3, 0}, std::vector<double>{0.1, 0.2, 0.0}, 0.1, 3.0, 0);
  EXPECT_EQ(slip.status, Status::slip);
  EXPECT_LT((slip.force_on_secondary - Point(-3, 0, -10)).norm(), 1e-14);
  EXPECT_NEAR(slip.gap, 0, 1e-15);
  EXPECT_EQ(state_of(point, false, std::vector<double>{10, 1, 0}, std::vector<double>{0, 0, 0}, 0, 3.0, 0).status, Status::stick);
  EXPECT_EQ(state_of(point, false, std::vector<double>{1e-6, 0, 0}, std::vector<double>{0, 0, 0}, 0, 3.0, 1e-3).status,
            Status::open);
  EXPECT_EQ(state_of(point, false, std::vector<double>{0, 0, 0}, std::vector<double>{0, 0, 0}, 0.2, 0.0, 0).status, Status::open);
  const auto sums = resultants(std::vector<ContactNodeState>{slip}, 1, comm);
  EXPECT_NEAR(sums[0].force[2], -10.0 * comm.size(), 1e-12);
  EXPECT_EQ(sums[0].slip, comm.size());
}

// A row that stands for neighbours without one sees more than the jump of the surfaces; what is told is the surfaces' own, and
// the normal force is that of the force vector.
TEST(State, IsThatOfTheSurfacesWhateverTheRowWeighs)
{
  constraint::ContactNode point{0, 7, 0.5, Point(0, 0, 1), {Point(1, 0, 0), Point(0, 1, 0)}, 0};
  const std::vector<double> multipliers{10, 3, 0};
  const auto plain = state_of(point, false, multipliers, std::vector<double>{0.1, 0.2, 0.0}, 0.4, 4.0, 0);
  point.weight = 1.25;
  const auto heavy = state_of(point, false, multipliers, std::vector<double>{0.125, 0.25, 0.0}, 0.5, 4.0, 0);
  EXPECT_NEAR(heavy.force, 12.5, 1e-14);
  EXPECT_NEAR(heavy.force, -heavy.force_on_secondary.dot(point.normal), 1e-14);
  EXPECT_NEAR(heavy.area, 0.625, 1e-15);
  EXPECT_NEAR(heavy.force / heavy.area, plain.force / plain.area, 1e-13);
  EXPECT_NEAR(heavy.gap, plain.gap, 1e-15);
  EXPECT_LT((heavy.slip - plain.slip).norm(), 1e-15);
  EXPECT_EQ(heavy.status, plain.status);
}

// Two faces in a row; the last two nodes are hardly covered and each give half of their force and area to the two before them.
// Points stand on the ranks in turn, faces wherever they are.
TEST(State, NarrowPointsGiveWhatPressesOnThemToTheirNeighbours)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({2, 1, 0, 1, 0, 1, true}, flat, comm),
                              surface({1, 1, 0, 1, 0, 1, false, false, primary_ids}, flat, comm), Law::frictionless);
  std::vector<ContactNodeState> points;
  for (Global node = 0; node < 6; ++node) {
    if (node % comm.size() != comm.rank()) continue;
    const bool narrow = node % 3 == 2;
    ContactNodeState point;
    point.node = node;
    point.area = narrow ? 0.05 : 0.5;
    point.cover = narrow ? 0.1 : 1;
    point.force = narrow ? 3 : 5;
    point.force_on_secondary = Point(0, narrow ? 1 : 2, 0);
    point.gap = 0.25;
    point.slip = Point(0, 0, 4);
    point.status = narrow ? Status::slip : Status::stick;
    points.push_back(point);
  }
  const auto state = surface_states(points, std::vector<Pair>{pair}, comm).front();
  for (std::size_t n = 0; n < pair.secondary.node_id.size(); ++n) {
    const bool alone = pair.secondary.node_id[n] % 3 == 0, narrow = pair.secondary.node_id[n] % 3 == 2;
    EXPECT_NEAR(state.pressure[n], alone ? 5 / 0.5 : (5 + 3) / 0.55, 1e-12);
    EXPECT_NEAR(state.traction[n][1], alone ? 2 / 0.5 : (2 + 1) / 0.55, 1e-12);
    EXPECT_NEAR(state.gap[n], 0.25, 1e-15);
    EXPECT_NEAR(state.slip[n][2], 4, 1e-14);
    EXPECT_EQ(state.status[n], static_cast<int>(narrow ? Status::slip : Status::stick));
  }
}

// Three faces in a row, each pair of nodes covered less than the one before: the last, which is next to nothing, has but one with
// little to give to, and that gives on. A face's worth of force over the area of a sliver shows nowhere.
TEST(State, SliversGiveOverOthersThatAreNarrow)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({3, 1, 0, 3, 0, 1, true}, flat, comm),
                              surface({1, 1, 0, 3, 0, 1, false, false, primary_ids}, flat, comm), Law::frictionless);
  const std::array<double, 4> area{0.5, 0.45, 0.15, 0.005}, force{5, 4, 1, 3};
  std::vector<ContactNodeState> points;
  for (Global node = 0; node < 8; ++node) {
    if (node % comm.size() != comm.rank()) continue;
    const auto column = static_cast<std::size_t>(node % 4);
    ContactNodeState point;
    point.node = node;
    point.area = area[column];
    point.cover = area[column];
    point.force = force[column];
    point.status = Status::slip;
    points.push_back(point);
  }
  const auto state = surface_states(points, std::vector<Pair>{pair}, comm).front();
  for (std::size_t n = 0; n < pair.secondary.node_id.size(); ++n) {
    const bool first = pair.secondary.node_id[n] % 4 == 0;
    EXPECT_NEAR(state.pressure[n], first ? 10 : 8 / 0.605, 1e-12);
    EXPECT_LT(state.recovered_pressure[n], 14);
  }
}

// Two faces in a row; the middle nodes have no rows, the last press more than the first, one of these not at all.
TEST(State, NodesWithoutRowsShowTheMeanOfTheirNeighbours)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({2, 1, 0, 1, 0, 1, true}, flat, comm),
                              surface({1, 1, 0, 1, 0, 1, false, false, primary_ids}, flat, comm), Law::frictionless);
  std::vector<ContactNodeState> points;
  std::vector<constraint::NodeWithoutRows> without_rows;
  for (Global node = 0; node < 6; ++node) {
    if (node % comm.size() != comm.rank()) continue;
    if (node % 3 == 1) {
      without_rows.push_back({0, node, {0, 0, 0}});
      continue;
    }
    ContactNodeState point;
    point.node = node;
    point.area = 0.25;
    point.force = node == 0 ? 0 : node % 3 == 0 ? 1 : 2;
    point.gap = node == 0 ? 0.4 : 0;
    point.force_on_secondary = Point(0, 0, -point.force);
    point.slip = Point(3, 0, 0);
    point.status = node == 0 ? Status::open : Status::stick;
    points.push_back(point);
  }
  const auto state = surface_states(points, std::vector<Pair>{pair}, comm, without_rows).front();
  EXPECT_NEAR(state.area, 0.75, 1e-15);
  for (std::size_t n = 0; n < pair.secondary.node_id.size(); ++n) {
    const bool bare = pair.secondary.node_id[n] % 3 == 1;
    EXPECT_EQ(state.without_rows[n] != 0, bare);
    if (!bare) continue;
    EXPECT_NEAR(state.pressure[n], 5, 1e-12);
    EXPECT_NEAR(state.recovered_pressure[n], 5, 1e-12);
    EXPECT_NEAR(state.traction[n][2], -5, 1e-12);
    EXPECT_NEAR(state.gap[n], 0.1, 1e-15);
    EXPECT_EQ(state.slip[n].norm(), 0);
    EXPECT_EQ(state.status[n], static_cast<int>(Status::stick));
  }
}

// Scatter that alternates from node to node goes, a constant stays, and so does a slope inside.
TEST(State, RecoveredPressureIsSmooth)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({4, 4, 0, 1, 0, 1, true}, flat, comm),
                              surface({5, 3, 0, 1, 0, 1, false, false, primary_ids}, flat, comm), Law::frictionless);
  const auto pressure = [](double x, double scatter) { return 10 + x + scatter; };
  std::vector<ContactNodeState> points;
  if (comm.root())
    for (Global node = 0; node < 25; ++node) {
      const bool edge_x = node % 5 == 0 || node % 5 == 4, edge_y = node / 5 == 0 || node / 5 == 4;
      ContactNodeState point;
      point.node = node;
      point.area = (edge_x ? 0.5 : 1.0) * (edge_y ? 0.5 : 1.0);
      point.force = point.area * pressure(0.25 * static_cast<double>(node % 5), (node % 5 + node / 5) % 2 == 0 ? 1 : -1);
      points.push_back(point);
    }
  const auto state = surface_states(points, std::vector<Pair>{pair}, comm).front();
  for (std::size_t n = 0; n < pair.secondary.node_id.size(); ++n) {
    const Point& x = pair.secondary.points[n];
    const bool inside = x[0] > 0.1 && x[0] < 0.9 && x[1] > 0.1 && x[1] < 0.9;
    EXPECT_NEAR(state.recovered_pressure[n], pressure(x[0], 0), inside ? 1e-12 : 0.13);
    EXPECT_NEAR(std::abs(state.pressure[n] - pressure(x[0], 0)), 1, 1e-12);
  }
}

// A ridge of 90 degrees, one side of which presses with 10 up to the ridge while the other is open.
TEST(State, AnEdgeHasThePressureOfTheSideThatPresses)
{
  const Communicator comm;
  const auto roof = [](double x, double y) { return Point(x, y, -std::abs(x)); };
  const auto pair = make_pair(surface({4, 2, -2, 2, 0, 1, true}, roof, comm),
                              surface({1, 1, 0, 1, 0, 1, false, false, primary_ids}, roof, comm), Law::frictionless);
  std::vector<ContactNodeState> points;
  if (comm.root())
    for (Global node = 0; node < 15; ++node)
      for (const double side : {-1.0, 1.0}) {
        const double x = static_cast<double>(node % 5) - 2;
        if (x * side < 0) continue;
        ContactNodeState point;
        point.node = node;
        point.area = 0.5;
        point.normal = Point(side, 0, 1).normalized();
        point.force = side < 0 ? 5 : 0;
        point.force_on_secondary = -point.force * point.normal;
        point.gap = side < 0 ? 0 : 0.1;
        points.push_back(point);
      }
  const auto state = surface_states(points, std::vector<Pair>{pair}, comm).front();
  for (std::size_t n = 0; n < pair.secondary.node_id.size(); ++n) {
    const double pressure = pair.secondary.points[n][0] < 0.5 ? 10 : 0;
    EXPECT_NEAR(state.pressure[n], pressure, 1e-12);
    EXPECT_NEAR(state.recovered_pressure[n], pressure, 1e-12);
    EXPECT_NEAR(state.traction[n].norm(), pressure, 1e-12);
    EXPECT_NEAR(state.gap[n], pressure > 0 ? 0 : 0.1, 1e-12);
  }
}

}  // namespace
}  // namespace mortise::contact
