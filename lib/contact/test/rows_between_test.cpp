// Rows at places between nodes, where the other side comes nearest.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

// A crowned side of 7 x 5 faces of 1 over a flat one, nearest at (a, b).
constexpr double curvature = 0.04;
Pair crown(double a, double b, Law law, bool triangles, const Communicator& comm)
{
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto crowned = [&](double x, double y) { return Point(x, y, 0.5 * curvature * ((x - a) * (x - a) + (y - b) * (y - b))); };
  return make_pair(surface({7, 5, 0, 7, 0, 5, false, triangles}, crowned, comm),
                   surface({9, 8, -0.5, 7.5, -0.5, 5.5, true, false, primary_ids}, flat, comm), law);
}

using Field = std::function<double(double, double)>;
const std::vector<Field> fields{[](double, double) { return 1.0; },     [](double x, double) { return x; },
                                [](double, double y) { return y; },     [](double x, double y) { return x * y; },
                                [](double x, double) { return x * x; }, [](double, double y) { return y * y; }};

// What the face of a grid of faces of 1 makes of a field between its nodes.
double bilinear(const Field& f, const Point& at)
{
  const double x = std::floor(at[0]), y = std::floor(at[1]), s = at[0] - x, t = at[1] - y;
  return (1 - s) * (1 - t) * f(x, y) + s * (1 - t) * f(x + 1, y) + s * t * f(x + 1, y + 1) + (1 - s) * t * f(x, y + 1);
}

TEST(RowsBetween, SeeFieldsOfSecondOrderAtThePlaceAndPushBothSidesThere)
{
  const Communicator comm;
  for (const auto& [a, b] : {std::pair{3.5, 2.5}, {3.5, 2.5 + 0.2}, {3.3, 2.6}, {3.5, 2.0}, {3.4, 3.0}, {4.0, 2.5}}) {
    const auto pair = crown(a, b, Law::coulomb, false, comm);
    const auto contacts = discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm);
    long long found = 0;
    for (const auto& node : contacts.nodes) {
      if (node.parts.empty()) continue;
      ++found;
      // As exactly as smooth surfaces through nodes are known.
      EXPECT_LT((node.at - Point(a, b, 0)).head<2>().norm(), 1e-3);
      EXPECT_NEAR(node.gap, 0, 1e-3 * curvature);
      EXPECT_EQ(node.tangents.size(), 2U);
      EXPECT_NEAR(node.area, 1, 0.2);
      double parts = 0;
      for (const auto& part : node.parts) parts += part.part;
      EXPECT_NEAR(parts, 1, 1e-12);
      for (std::size_t k = 0; k < fields.size(); ++k) {
        const auto& f = fields[k];
        double own = 0, other = 0;
        for (const auto& e : contacts.rows[node.row]) {
          if (e.component != 2) continue;
          const bool on_primary = e.node >= primary_ids;
          const auto id = on_primary ? e.node - primary_ids : e.node;
          const double x = on_primary ? -0.5 + static_cast<double>(id % 10) * 8 / 9 : static_cast<double>(id % 8),
                       y = on_primary ? -0.5 + static_cast<double>(id / 10) * 6 / 8 : static_cast<double>(id / 8);
          (on_primary ? other : own) += e.coefficient * f(x, y);
        }
        const double sign = node.normal[2], here = f(node.at[0], node.at[1]);
        EXPECT_NEAR(sign * own, here + 0.2 * (here - bilinear(f, node.at)), 1e-6) << "field " << k;
        if (k < 3) {
          EXPECT_NEAR(sign * other, -here, 1e-6) << "field " << k;
        }
      }
    }
    EXPECT_EQ(comm.sum(found), 1) << a << " " << b;
  }
}

// Each node has its own row as if there were no such place.
TEST(RowsBetween, LeaveThoseOfTheNodesAsTheyAre)
{
  const Communicator comm;
  for (const bool triangles : {false, true}) {
    const auto pair = crown(3.4, 2.6, Law::frictionless, triangles, comm);
    const auto contacts = discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm);
    long long nodes = 0, places = 0;
    for (const auto& node : contacts.nodes) {
      node.parts.empty() ? ++nodes : ++places;
      if (!node.parts.empty()) continue;
      const auto id = static_cast<double>(node.node);
      const double x = std::fmod(id, 8), y = std::floor(id / 8);
      EXPECT_LT((node.at.head<2>() - Eigen::Vector2d(x, y)).norm(), 1e-12);
      EXPECT_NEAR(node.gap, 0.5 * curvature * ((x - 3.4) * (x - 3.4) + (y - 2.6) * (y - 2.6)), 1e-3 * curvature);
    }
    EXPECT_EQ(comm.sum(nodes), 48);
    EXPECT_EQ(comm.sum(places), 1);
  }
}

// Round a place faces of second order are seen facet by facet, so that rows mean the field at the nodes.
TEST(RowsBetween, OfFacesOfSecondOrderSeeLinearFieldsAndTheGapThere)
{
  const Communicator comm;
  for (const auto type : {mesh::CellType::tri6, mesh::CellType::quad8, mesh::CellType::quad9})
    for (const auto& [a, b] : {std::pair{3.4, 2.6}, {3.5, 2.75}, {3.25, 2.25}, {3.1, 2.7}}) {
      const bool triangles = type == mesh::CellType::tri6;
      auto pair = crown(a, b, Law::frictionless, triangles, comm);
      pair.secondary = second_order(pair.secondary, type, Eigen::Matrix3d::Identity(), 0);
      const auto height = [&](const Point& x) {
        return 0.5 * curvature * ((x[0] - a) * (x[0] - a) + (x[1] - b) * (x[1] - b));
      };
      for (auto& x : pair.secondary.points) x[2] = height(x);
      const auto at = nodes_of(pair, comm);
      const auto contacts = discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm);
      long long found = 0;
      for (const auto& node : contacts.nodes) {
        if (node.parts.empty()) {  // none has moved; those round the place have the gap there and no control value
          EXPECT_LT((node.at - at.at(node.node)).norm(), 0.01);
          if ((node.at - Point(a, b, 0)).head<2>().norm() < 0.6) {
            EXPECT_NEAR(node.gap, height(node.at), 1e-3 * curvature);
          }
          continue;
        }
        ++found;
        EXPECT_LT((node.at - Point(a, b, 0)).head<2>().norm(), 1e-3);
        EXPECT_NEAR(node.gap, 0, 1e-3 * curvature);
        double parts = 0;
        for (const auto& part : node.parts) parts += part.part;
        EXPECT_NEAR(parts, 1, 1e-12);
        for (std::size_t k = 0; k < 3; ++k) {
          double own = 0, other = 0;
          for (const auto& e : contacts.rows[node.row]) {
            if (e.component != 2) continue;
            const auto& x = at.at(e.node);
            (e.node >= primary_ids ? other : own) += e.coefficient * fields[k](x[0], x[1]);
          }
          const double here = node.normal[2] * fields[k](node.at[0], node.at[1]);
          EXPECT_NEAR(own, here, 1e-6) << "field " << k;
          EXPECT_NEAR(other, -here, 1e-6) << "field " << k;
        }
      }
      EXPECT_EQ(comm.sum(found), 1) << a << " " << b;
    }
}

// The places between nodes over all ranks, ascending, and their gaps.
std::vector<std::pair<Point, double>> places_of(const Pair& pair, const Communicator& comm)
{
  const auto contacts = discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm);
  std::vector<std::array<double, 4>> mine;
  for (const auto& node : contacts.nodes)
    if (!node.parts.empty()) mine.push_back({node.at[0], node.at[1], node.at[2], node.gap});
  mine = comm.all_gather(mine);
  std::ranges::sort(mine);
  std::vector<std::pair<Point, double>> result;
  for (const auto& place : mine) result.emplace_back(Point(place[0], place[1], place[2]), place[3]);
  return result;
}

// Bumps of two and a half faces, each with its top in the middle of a face: what normals change by all round a node says nothing.
TEST(RowsBetween, AreFoundOnBumpsLittleWiderThanAFace)
{
  const Communicator comm;
  const double height = 0.01;
  const auto bumps = [&](double x, double y) {
    return Point(x, y, height * (1 - std::pow(std::sin(std::numbers::pi * x) * std::sin(std::numbers::pi * y), 2)));
  };
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  for (const bool triangles : {false, true}) {
    const auto places = places_of(make_pair(surface({10, 10, 0, 2, 0, 2, false, triangles}, bumps, comm),
                                            surface({7, 7, 0, 2, 0, 2, true, false, primary_ids}, flat, comm), Law::frictionless),
                                  comm);
    for (const double x : {0.5, 1.5})
      for (const double y : {0.5, 1.5}) {
        const auto top = std::ranges::find_if(places, [&](const auto& p) { return std::hypot(p.first[0] - x, p.first[1] - y) < 0.02; });
        ASSERT_NE(top, places.end()) << x << " " << y;
        EXPECT_LT(std::abs(top->second), 0.1 * height);
      }
  }
}

// Half of a round side that ends in a plane of symmetry, nearest in the middle of an edge there.
TEST(RowsBetween, AreFoundOnEdgesOfTheBorder)
{
  const Communicator comm;
  const auto round = [](double x, double y) { return Point(x, y, (x * x + y * y) / 10); };
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  for (const bool swapped : {false, true}) {
    const Grid grid{2, 3, 0, 4.0 / 3, -1, 1, false}, other{2, 3, 0, 4.0 / 3, -1, 1, true, false, primary_ids};
    auto pair = make_pair(surface(grid, round, comm), surface(other, flat, comm), Law::frictionless);
    if (swapped) pair = make_pair(*pair.primary, pair.secondary, Law::frictionless);
    const auto places = places_of(pair, comm);
    ASSERT_EQ(places.size(), 1U);
    EXPECT_LT(places[0].first.head<2>().norm(), 1e-6);
    EXPECT_NEAR(places[0].second, 0, 1e-3);
  }
}

// Tresca's bound is an area's, which the nodes have already.
TEST(RowsBetween, HaveNoFrictionOfTresca)
{
  const Communicator comm;
  const auto contacts =
      discretize(std::vector<Pair>{crown(3.5, 2.5, Law::tresca, false, comm)}, {}, fem::Kinematics::solid, comm);
  for (const auto& node : contacts.nodes) EXPECT_EQ(node.tangents.size(), node.parts.empty() ? 2U : 0U);
}

}  // namespace
}  // namespace mortise::contact
