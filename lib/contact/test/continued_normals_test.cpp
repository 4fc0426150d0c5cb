// Where sides end in planes of symmetry, at supports and at cuts of sectors, normals are those of the whole surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

// How far the normals of `part` at its nodes are at most from those of the `whole` at the same places.
double apart_from_whole(const Gathered& part, const std::map<Global, Point>& part_nodes, const Gathered& whole,
                        const std::map<Global, Point>& whole_nodes)
{
  double most = 0;
  for (const auto& row : part.rows) {
    if (!row.is_normal || !part_nodes.contains(row.node)) continue;
    const Point& x = part_nodes.at(row.node);
    const auto same = std::ranges::find_if(
        whole.rows, [&](const auto& other) { return other.is_normal && (whole_nodes.at(other.node) - x).norm() < 1e-9; });
    most = std::max(most, same == whole.rows.end() ? 1.0 : (row.normal - same->normal).norm());
  }
  return most;
}

// What ends in planes of symmetry has the normals of the whole there, also where two of them meet.
TEST(SmoothNormals, InPlanesOfSymmetryAreThoseOfTheWhole)
{
  const Communicator comm;
  const auto hollow = [](double x, double y) { return Point(x, y, -0.3 * std::cos(1.3 * x) * std::cos(1.5 * y)); };
  const auto lid = [&](double x, double y) { return Point(x, y, hollow(x, y)[2] + 0.1); };
  auto whole = make_pair(surface({8, 10, -1.2, 1.2, -1, 1, true}, hollow, comm),
                         surface({7, 7, -1.4, 1.4, -1.4, 1.4, false, false, primary_ids}, lid, comm), Law::frictionless);
  whole.options.search_distance = 2;
  const auto of_whole = gather_rows(discretize(std::vector<Pair>{whole}, {}, fem::Kinematics::solid, comm), comm);
  for (const bool quarter : {false, true}) {
    auto part = whole;
    part.secondary = surface({4, quarter ? 5 : 10, 0, 1.2, quarter ? 0.0 : -1.0, 1, true}, hollow, comm);
    const auto nodes = nodes_of(part, comm);
    std::vector<constraint::PrescribedDof> prescribed;
    for (std::size_t n = 0; n < part.secondary.points.size(); ++n) {
      const Point& x = part.secondary.points[n];
      if (x[0] == 0) prescribed.push_back({part.secondary.node_id[n], 0, 0, 0});
      if (quarter && x[1] == 0) prescribed.push_back({part.secondary.node_id[n], 1, 0, 0});
    }
    const auto rows = gather_rows(discretize(std::vector<Pair>{part}, prescribed, fem::Kinematics::solid, comm), comm);
    EXPECT_EQ(rows.rows.size(), quarter ? 30U : 55U);
    EXPECT_LT(apart_from_whole(rows, nodes, of_whole, nodes_of(whole, comm)), 1e-8);
    const auto alone = gather_rows(discretize(std::vector<Pair>{part}, {}, fem::Kinematics::solid, comm), comm);
    EXPECT_GT(apart_from_whole(alone, nodes, of_whole, nodes_of(whole, comm)), 1e-3);
  }
}

// A support that holds a slope where it ends is none of symmetry: a wedge, a cone that is held at its end.
TEST(SmoothNormals, OfASlopeThatIsHeldAtItsEndAreItsOwn)
{
  const Communicator comm;
  for (const double curvature : {0.0, 0.05}) {
    const auto slope = [&](double x, double y) { return Point(x, y, 0.2 * x + curvature * x * x / 2); };
    const auto lid = [&](double x, double y) { return Point(x, y, slope(x, y)[2] + 0.01); };
    const auto pair = make_pair(surface({5, 4, 0, 1, 0, 1, true}, slope, comm),
                                surface({4, 5, -0.2, 1.2, -0.2, 1.2, false, false, primary_ids}, lid, comm), Law::frictionless);
    const auto nodes = nodes_of(pair, comm);
    std::vector<constraint::PrescribedDof> prescribed;
    for (std::size_t n = 0; n < pair.secondary.points.size(); ++n)
      if (pair.secondary.points[n][0] == 0) prescribed.push_back({pair.secondary.node_id[n], 0, 0, 0});
    for (const auto& row :
         gather_rows(discretize(std::vector<Pair>{pair}, prescribed, fem::Kinematics::solid, comm), comm).rows) {
      const Point expected = Point(-0.2 - curvature * nodes.at(row.node)[0], 0, 1).normalized();
      EXPECT_LT((row.normal - expected).norm(), curvature == 0 ? 1e-12 : 2e-4) << nodes.at(row.node).transpose();
    }
  }
}

// A quarter of a surface that is the same after quarter turns, and not after reflections; its cuts are bonded.
TEST(SmoothNormals, AtTheCutsOfASectorAreThoseOfTheWhole)
{
  const Communicator comm;
  const auto shape = [](double x, double y) {
    return Point(x, y, 0.1 * x * y * (x * x - y * y) - 0.3 * (std::cos(1.3 * x) + std::cos(1.3 * y)));
  };
  const auto lid = [&](double x, double y) { return Point(x, y, shape(x, y)[2] + 0.1); };
  auto whole = make_pair(surface({10, 10, -1, 1, -1, 1, true}, shape, comm),
                         surface({56, 56, -1.4, 1.4, -1.4, 1.4, false, false, primary_ids}, lid, comm), Law::frictionless);
  whole.options.search_distance = 2;
  const auto of_whole = gather_rows(discretize(std::vector<Pair>{whole}, {}, fem::Kinematics::solid, comm), comm);
  auto sector = whole;
  sector.secondary = surface({5, 5, 0, 1, 0, 1, true}, shape, comm);
  const auto nodes = nodes_of(sector, comm);
  const auto apart = [&](const std::vector<Pair>& pairs) {
    auto rows = gather_rows(discretize(pairs, {}, fem::Kinematics::solid, comm), comm);
    std::erase_if(rows.rows, [&](const Gathered::Row& row) {  // the bond's, and on the axis, which turns into itself
      return !nodes.contains(row.node) || std::abs(row.normal[2]) < 0.5 || nodes.at(row.node).head<2>().norm() == 0;
    });
    return apart_from_whole(rows, nodes, of_whole, nodes_of(whole, comm));
  };
  // How the two sides share in the direction depends a little on the faces on one side of the cut.
  EXPECT_LT(apart({sector, bond_of_quarter(sector.secondary, comm)}), 5e-4);
  EXPECT_GT(apart({sector}), 2e-3);
}

// The whole has kinks at the cuts, where the sector keeps the normals that it has alone.
TEST(SmoothNormals, AtTheCutsOfASectorEndAtAKink)
{
  const Communicator comm;
  const auto shape = [](double x, double y) { return Point(x, y, -0.15 * x * y); };
  const auto lid = [&](double x, double y) { return Point(x, y, shape(x, y)[2] + 0.1); };
  auto sector = make_pair(surface({5, 5, 0, 1, 0, 1, true}, shape, comm),
                          surface({7, 7, -0.2, 1.4, -0.2, 1.4, false, false, primary_ids}, lid, comm), Law::frictionless);
  sector.options.search_distance = 2;
  const auto contacts =
      discretize(std::vector<Pair>{sector, bond_of_quarter(sector.secondary, comm)}, {}, fem::Kinematics::solid, comm);
  const auto nodes = nodes_of(sector, comm);
  int at_cut = 0;
  for (const auto& row : gather_rows(contacts, comm).rows) {
    if (!nodes.contains(row.node) || std::abs(row.normal[2]) < 0.5 || !row.is_normal) continue;
    const Point& x = nodes.at(row.node);
    at_cut += x[1] == 0;
    EXPECT_LT((row.normal - Point(0.15 * x[1], 0.15 * x[0], 1).normalized()).norm(), 3e-3) << x.transpose();
  }
  EXPECT_GE(at_cut, 5);
}

}  // namespace
}  // namespace mortise::contact
