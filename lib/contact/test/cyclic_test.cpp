// Sectors: rows of cuts that are turned onto each other.
#include "contact/cyclic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "contact/mortar.hpp"

namespace mortise::contact {
namespace {

constexpr double angle = 40;

// A cut of a sector at `degrees` about z, from radius `inner` to 2 and from z = 0 to 1, n x m faces; `out` along the turn or
// against it. On the axis both cuts have the same nodes, numbered from 0.
mesh::Surface cut(double degrees, double inner, int n, int m, bool out, Global first, const Communicator& comm)
{
  mesh::Surface surface;
  const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
  std::map<Global, Local> local;
  std::vector<std::pair<Global, Point>> nodes;
  const auto id = [&](int i, int j) { return i == 0 && inner == 0 ? j : first + i * (m + 1) + j; };
  std::vector<std::array<Global, 4>> faces;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      if ((i * m + j) % comm.size() != comm.rank()) continue;
      std::array<Global, 4> face{id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)};
      if (out) std::swap(face[1], face[3]);
      faces.push_back(face);
      surface.face_id.push_back(first + i * m + j);
      surface.body.push_back(0);
      for (int a = i; a <= i + 1; ++a)
        for (int b = j; b <= j + 1; ++b) {
          const double r = inner + (2 - inner) * a / n;
          if (local.emplace(id(a, b), 0).second) nodes.emplace_back(id(a, b), Point(r * c, r * s, static_cast<double>(b) / m));
        }
    }
  std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [node, x] : nodes) {
    local[node] = static_cast<Local>(surface.points.size());
    surface.node_id.push_back(node);
    surface.points.push_back(x);
  }
  for (const auto& face : faces) {
    std::vector<Local> corners;
    for (const Global node : face) corners.push_back(local[node]);
    surface.faces.add(mesh::CellType::quad4, corners);
  }
  return surface;
}

struct Sector {
  std::vector<Pair> pairs;
  std::map<Global, Point> at;  // of all nodes, where they lie in the mesh
};

Sector sector(double inner, int n, int other_n, double rotation, const Communicator& comm)
{
  Sector result;
  Options options;
  options.name = "cuts";
  options.law = Law::bonded;
  options.cyclic = mesh::RotationOptions{{0, 0, 3}, rotation, {0, 0, 0.2}};
  const auto secondary = cut(10 + angle, inner, n, 3, true, 100, comm), primary = cut(10, inner, other_n, 3, false, 1000, comm);
  struct Node {
    Global id;
    std::array<double, 3> x;
  };
  std::vector<Node> mine;
  for (const auto* side : {&secondary, &primary})
    for (std::size_t i = 0; i < side->points.size(); ++i)
      mine.push_back({side->node_id[i], {side->points[i][0], side->points[i][1], side->points[i][2]}});
  for (const auto& node : comm.all_gather(mine)) result.at[node.id] = Point(node.x[0], node.x[1], node.x[2]);
  result.pairs.push_back({options, secondary, std::make_shared<const mesh::Surface>(rotated(primary, options))});
  return result;
}

// The largest |row . u|.
template <class Field>
double felt(const constraint::Contacts& contacts, const Sector& sector, const Field& u, const Communicator& comm)
{
  double largest = 0;
  for (std::size_t r = 0; r < contacts.rows.size(); ++r) {
    double sum = 0;
    for (const auto& e : contacts.rows[r]) sum += e.coefficient * u(sector.at.at(e.node))[e.component];
    largest = std::max(largest, std::abs(sum));
  }
  return comm.max(largest);
}

class Cuts : public testing::TestWithParam<std::tuple<double, int>> {};

// u(R x) = R u(x) holds for A x if A commutes with the rotation: stretches across and along the axis and the turn about it.
TEST_P(Cuts, FieldsThatRepeatAreNotFeltAndOthersAre)
{
  const Communicator comm;
  const auto [inner, other] = GetParam();
  const auto model = sector(inner, 5, other, angle, comm);
  const auto contacts = discretize(model.pairs, {}, fem::Kinematics::solid, comm);
  EXPECT_GT(comm.sum(static_cast<long long>(contacts.nodes.size())), 20);
  for (const double bound : contacts.rows.bound) EXPECT_EQ(bound, 0);
  const auto repeating = [](const Point& x) { return Point(0.3 * x[0] - 2 * x[1], 2 * x[0] + 0.3 * x[1], 5 - 0.7 * x[2]); };
  EXPECT_LT(felt(contacts, model, repeating, comm), 1e-12);
  // Of a translation t the rows feel (1 - R) t, 2 sin(20 degrees) |t| across the axis.
  const auto moved = [](const Point&) { return Point(0, 1, 0); };
  const double difference = felt(contacts, model, moved, comm);
  EXPECT_LT(difference, 2 * std::sin(angle / 2 * std::numbers::pi / 180) + 1e-12);
  EXPECT_GT(difference, 0.5);
  const auto twisted = [](const Point& x) { return Point(0, 0, x[0]); };
  EXPECT_GT(felt(contacts, model, twisted, comm), 0.2);
}

// Nodes on the axis are on both sides: a row has each of their components once.
TEST_P(Cuts, RowsNameEachComponentOnce)
{
  const Communicator comm;
  const auto [inner, other] = GetParam();
  const auto model = sector(inner, 5, other, angle, comm);
  const auto contacts = discretize(model.pairs, {}, fem::Kinematics::solid, comm);
  for (std::size_t r = 0; r < contacts.rows.size(); ++r) {
    std::set<std::pair<Global, int>> seen;
    double largest = 0;
    for (const auto& e : contacts.rows[r]) {
      EXPECT_TRUE(seen.emplace(e.node, e.component).second);
      largest = std::max(largest, std::abs(e.coefficient));
    }
    EXPECT_GT(largest, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, Cuts, testing::Combine(testing::Values(0.0, 1.0), testing::Values(5, 7)));

TEST(Cyclic, MatchingCutsGivePairsOfTurnedNodes)
{
  const Communicator comm;
  const auto model = sector(1, 4, 4, angle, comm);
  const auto rotation = rotation_of(model.pairs[0].options);
  ASSERT_TRUE(rotation.has_value());
  const auto contacts = discretize(model.pairs, {}, fem::Kinematics::solid, comm);
  for (const auto& point : contacts.nodes) {
    ASSERT_EQ(point.tangents.size(), 2U);
    for (std::size_t r = 0; r < 3; ++r) {
      const Point axis = r == 0 ? point.normal : point.tangents[r - 1], other = -rotation->rotation.transpose() * axis;
      for (const auto& e : contacts.rows[point.row + r]) {
        const bool on_primary = e.node >= 1000;
        EXPECT_LT(((on_primary ? (*rotation)(model.at.at(e.node)) : model.at.at(e.node)) - point.at).norm(), 1e-12);
        EXPECT_NEAR(e.coefficient, (on_primary ? other : axis)[e.component], 1e-12);
      }
    }
  }
}

TEST(Cyclic, CutsThatDoNotMeetAreAnError)
{
  const Communicator comm;
  for (const double rotation : {-angle, 36.0, 45.0}) {
    const auto model = sector(1, 4, 5, rotation, comm);
    try {
      discretize(model.pairs, {}, fem::Kinematics::solid, comm);
      ADD_FAILURE() << "no error at " << rotation;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("does not lie on the secondary one"), std::string::npos) << error.what();
    }
  }
}

TEST(Cyclic, AnglesArePartsOfATurn)
{
  using fem::Kinematics;
  EXPECT_EQ(misfit({{0, 0, 1}, -40, {0, 0, 0}}, Kinematics::solid), "");
  EXPECT_EQ(misfit({{0, 0, 1}, 360.0 / 7, {0, 0, 0}}, Kinematics::plane_strain), "");
  EXPECT_NE(misfit({{0, 0, 1}, 35, {0, 0, 0}}, Kinematics::solid).find("360/10 = 36"), std::string::npos);
  EXPECT_NE(misfit({{0, 0, 1}, 360, {0, 0, 0}}, Kinematics::solid), "");
  EXPECT_NE(misfit({{0, 0, 1}, 0, {0, 0, 0}}, Kinematics::solid), "");
  EXPECT_NE(misfit({{0, 1, 0}, 40, {0, 0, 0}}, Kinematics::plane_stress).find("[0, 0, 1]"), std::string::npos);
  EXPECT_NE(misfit({{0, 1, 0}, 40, {0, 0, 0}}, Kinematics::axisymmetric), "");
}

}  // namespace
}  // namespace mortise::contact
