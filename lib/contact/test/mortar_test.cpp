// Contact rows judged without any finite element: what they say of rigid motions and linear fields, and what a constant pressure
// does.
#include "contact/mortar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

using mesh::CellType;

// Nodal forces of a constant unit pressure on the faces of one side, integrated with many points.
std::map<Global, Point> consistent(const mesh::Surface& side, const Communicator& comm)
{
  std::map<Global, Point> mine;
  constexpr int n = 12;
  for (std::size_t f = 0; f < side.faces.size(); ++f) {
    const auto nodes = side.faces[f];
    std::vector<Point> x;
    for (const Local l : nodes) x.push_back(side.points[static_cast<std::size_t>(l)]);
    if (nodes.size() == 3) {
      const Point area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
      for (const Local l : nodes)
        mine.try_emplace(side.node_id[static_cast<std::size_t>(l)], Point::Zero()).first->second += area / 3;
      continue;
    }
    for (int i = 0; i < n; ++i)  // composite two-point Gauss: exact for what stands here
      for (int j = 0; j < n; ++j) {
        const auto gauss = [&](int k, double& at) {
          at = -1 + (2.0 * (k / 2) + 1 + (k % 2 == 0 ? -1 : 1) / std::sqrt(3.0)) / (n / 2);
          return 1.0 / (n / 2);
        };
        double s = 0, t = 0;
        const double w = gauss(i, s) * gauss(j, t);
        const double shape[4] = {(1 - s) * (1 - t) / 4, (1 + s) * (1 - t) / 4, (1 + s) * (1 + t) / 4, (1 - s) * (1 + t) / 4};
        const Point ds = ((x[1] - x[0]) * (1 - t) + (x[2] - x[3]) * (1 + t)) / 4,
                    dt = ((x[3] - x[0]) * (1 - s) + (x[2] - x[1]) * (1 + s)) / 4;
        for (std::size_t k = 0; k < 4; ++k)
          mine.try_emplace(side.node_id[static_cast<std::size_t>(nodes[k])], Point::Zero()).first->second +=
              w * shape[k] * ds.cross(dt);
      }
  }
  std::vector<double> flat;
  for (const auto& [node, force] : mine) flat.insert(flat.end(), {static_cast<double>(node), force[0], force[1], force[2]});
  flat = comm.all_gather(flat);
  std::map<Global, Point> result;
  for (std::size_t i = 0; i < flat.size(); i += 4)
    result.try_emplace(static_cast<Global>(flat[i]), Point::Zero()).first->second += Point(flat[i + 1], flat[i + 2], flat[i + 3]);
  return result;
}

class Patch : public testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(Patch, ConstantPressureIsConsistentOnBothSidesAndLinearFieldsPass)
{
  const Communicator comm;
  const auto [secondary_triangles, primary_triangles] = GetParam();
  // An inclined plane.
  const auto plane = [](double x, double y) { return Point(x, y, 0.3 * x - 0.2 * y); };
  const auto pair = make_pair(surface({5, 4, 0, 1, 0, 1, true, secondary_triangles, 0, 0.2}, plane, comm),
                              surface({3, 7, 0, 1, 0, 1, false, primary_triangles, primary_ids, 0.2}, plane, comm), Law::bonded);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  ASSERT_EQ(rows.rows.size(), 3U * 30U);

  Eigen::Matrix3d gradient;
  gradient << 1, 2, 3, -1, 0.5, 2, 0.3, -2, 1;
  const auto nodes = nodes_of(pair, comm);
  std::map<Global, Point> force;
  double area = 0;
  for (const auto& row : rows.rows) {
    double jump = 0;
    for (const auto& e : row.entries) jump += e.coefficient * (gradient * nodes.at(e.node) + Point(1, 2, 3))[e.component];
    EXPECT_NEAR(jump, 0, 1e-12);
    if (!row.is_normal) continue;
    EXPECT_NEAR(row.bound, 0, 1e-12);
    area += row.area;
    for (const auto& e : row.entries)
      force.try_emplace(e.node, Point::Zero()).first->second[e.component] += row.area * e.coefficient;
  }
  EXPECT_NEAR(area, std::sqrt(1 + 0.09 + 0.04), 1e-10);
  for (const auto* side : {&pair.secondary, pair.primary.get()})
    for (const auto& [node, expected] : consistent(*side, comm))
      EXPECT_LT((force.at(node) - expected).norm(), 1e-10) << "node " << node;
}

INSTANTIATE_TEST_SUITE_P(Faces, Patch, testing::Combine(testing::Bool(), testing::Bool()));

TEST(Mortar, MatchingMeshesGiveNodePairsAlsoAtTheBorderOfTheOverlap)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({8, 2, 0, 2, 0, 0.5, true}, flat, comm),
                              surface({8, 2, 0.5, 2.5, 0, 0.5, false, false, primary_ids}, flat, comm), Law::tresca);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  EXPECT_EQ(rows.rows.size(), 3U * 7U * 3U);  // x = 0.5 .. 2, three nodes across, three rows each
  const auto nodes = nodes_of(pair, comm);
  for (const auto& row : rows.rows) {
    ASSERT_EQ(row.entries.size(), 2U);
    EXPECT_NEAR(std::abs(row.entries[0].coefficient), 1, 1e-12);
    EXPECT_NEAR(row.entries[0].coefficient + row.entries[1].coefficient, 0, 1e-12);
    EXPECT_LT((nodes.at(row.entries[0].node) - nodes.at(row.entries[1].node)).norm(), 1e-12);
    const double x = nodes.at(row.node)[0], y = nodes.at(row.node)[1];
    EXPECT_NEAR(row.area, 0.0625 * (x < 0.6 || x > 1.9 ? 0.5 : 1) * (y < 0.1 || y > 0.4 ? 0.5 : 1), 1e-12);
  }
}

// A side of which one border is prescribed along the normal: its nodes keep rows that the primary side alone feels.
class PrescribedBorder : public testing::TestWithParam<Law> {};

TEST_P(PrescribedBorder, ForcesAreConsistentWithWhatGoesIntoSupports)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({4, 4, 0, 1, 0, 1, true}, flat, comm),
                              surface({5, 3, 0, 1, 0, 1, false, false, primary_ids}, flat, comm), GetParam());
  std::vector<constraint::PrescribedDof> prescribed;
  if (comm.root())
    for (const Global node : {0, 5, 10, 15, 20}) {                   // x = 0: prescribed along the normal, and along y
      prescribed.push_back({node, 2, 0.5, static_cast<int>(node)});  // each by a support of its own
      prescribed.push_back({node, 1, 0, static_cast<int>(node)});
    }
  if (comm.root()) prescribed.push_back({24, 0, 0, 24});  // one tangential component at a corner
  const auto contacts = discretize(std::vector<Pair>{pair}, prescribed, fem::Kinematics::solid, comm);
  for (const auto& point : contacts.nodes) {
    const bool of_border = point.node % 5 == 0;
    const auto& bound = contacts.rows.bound[point.row];
    EXPECT_NEAR(point.gap - bound, of_border ? 0.5 * point.normal[2] : 0.0, 1e-12) << "node " << point.node;
    for (const auto& entry : contacts.rows[point.row]) EXPECT_TRUE(!of_border || entry.node >= primary_ids);
    if (point.node == 24) {
      ASSERT_EQ(point.tangents.size(), 2U);
      EXPECT_NEAR(std::abs(point.tangents[0][1]), 1, 1e-12);
      EXPECT_NEAR(std::abs(point.tangents[1][0]), 1, 1e-12);  // along x, too, which the primary side alone feels
      for (const auto& entry : contacts.rows[point.row + 2]) EXPECT_GE(entry.node, primary_ids);
    }
  }
  const auto rows = gather_rows(contacts, comm);
  std::map<Global, Point> force;
  for (const auto& row : rows.rows)
    if (row.is_normal)
      for (const auto& e : row.entries)
        force.try_emplace(e.node, Point::Zero()).first->second[e.component] += row.area * e.coefficient;
  // What acts on prescribed components goes into their supports, and what these move stands in the bounds.
  std::vector<double> supported(3 * 25, 0.0);
  double shift = 0, expected_shift = 0;
  for (const auto& point : contacts.nodes) {
    shift += point.gap - contacts.rows.bound[point.row];
    for (const auto& entry : contacts.prescribed) {
      if (entry.row != point.row) continue;
      supported[3 * static_cast<std::size_t>(entry.support) + static_cast<std::size_t>(entry.component)] +=
          point.area * entry.coefficient;
      expected_shift += entry.component == 2 ? 0.5 * entry.coefficient : 0.0;
    }
    for (const auto& entry : contacts.rows[point.row])
      EXPECT_FALSE(entry.node < 25 && entry.node % 5 == 0 && entry.component > 0);
  }
  EXPECT_NEAR(shift, expected_shift, 1e-12);
  EXPECT_GT(comm.sum(expected_shift), 0.1);
  comm.sum_in_place(supported);
  for (Global node = 0; node < 25; ++node) {
    auto& sum = force.try_emplace(node, Point::Zero()).first->second;
    for (std::size_t c = 0; c < 3; ++c) sum[static_cast<Eigen::Index>(c)] += supported[3 * static_cast<std::size_t>(node) + c];
  }
  for (const auto* side : {&pair.secondary, pair.primary.get()})
    for (const auto& [node, expected] : consistent(*side, comm))
      EXPECT_LT((force.at(node) - expected).norm(), 1e-11) << "node " << node;
}

INSTANTIATE_TEST_SUITE_P(Laws, PrescribedBorder, testing::Values(Law::bonded, Law::tresca));

// Where supports hold the primary side as well, a row of a bond would hold what lies beside them.
TEST(Mortar, NodesOfABondLeaveTheirShareWhereBothSidesAreHeld)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({4, 4, 0, 1, 0, 1, true}, flat, comm),
                              surface({5, 3, 0, 1, 0, 1, false, false, primary_ids}, flat, comm), Law::bonded);
  std::vector<constraint::PrescribedDof> prescribed;
  if (comm.root())
    for (int row = 0; row < 5; ++row)
      for (int component = 0; component < 3; ++component) {
        prescribed.push_back({5 * row, component, 0, 0});
        if (row < 4) prescribed.push_back({primary_ids + 6 * row, component, 0, 1});
      }
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, prescribed, fem::Kinematics::solid, comm), comm);
  double force = 0;
  for (const auto& row : rows.rows) {
    EXPECT_NE(row.node % 5, 0);
    if (row.is_normal) force += row.area * row.weight;
  }
  EXPECT_NEAR(force, 1, 1e-12);
}

TEST(Mortar, KinksHaveAPointForEachSide)
{
  const Communicator comm;
  const auto roof = [](double x, double y) { return Point(x, y, -std::abs(x)); };
  const auto pair = make_pair(surface({4, 2, -1, 1, 0, 1, true}, roof, comm),
                              surface({6, 3, -1, 1, 0, 1, false, false, primary_ids}, roof, comm), Law::frictionless);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  EXPECT_EQ(rows.rows.size(), 15U + 3U);
  for (const auto& row : rows.rows) EXPECT_NEAR(std::abs(row.normal[0]), std::sqrt(0.5), 1e-12);
}

// Concentric arcs whose facets do not match: the gap of the circles, not of the facets, and normals through the centre.
TEST(Mortar, FacetedCylindersHaveTheGapOfTheirCircles)
{
  const Communicator comm;
  const auto arc = [](double radius) {
    return [radius](double x, double y) { return Point(radius * std::sin(x), y, radius * std::cos(x)); };
  };
  auto pair = make_pair(surface({8, 2, -0.6, 0.6, 0, 1, true}, arc(10), comm),
                        surface({11, 3, -0.6, 0.6, 0, 1, false, false, primary_ids}, arc(10.03), comm), Law::frictionless);
  pair.options.interference = 0.02;
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  EXPECT_EQ(rows.rows.size(), 27U);
  const auto nodes = nodes_of(pair, comm);
  for (const auto& row : rows.rows) {
    EXPECT_NEAR(row.bound, 0.01, 2e-4);  // the facets alone are wrong by up to 0.03
    const Point x = nodes.at(row.node);
    EXPECT_LT((row.normal - Point(x[0], 0, x[2]) / 10).norm(), 1e-10);
  }
}

// Facets that do not match: forces pass on their moments, so that no row feels both sides turn together. What lets the cylinder
// slide along itself no normal row feels at all, though facets tilt.
TEST(Mortar, FacetedCylindersPassOnMomentsAndSlideAlongThemselves)
{
  const Communicator comm;
  const auto arc = [](double x, double y) { return Point(10 * std::sin(x), y, 10 * std::cos(x)); };
  for (const bool triangles : {false, true}) {
    auto pair = make_pair(surface({9, 3, -0.6, 0.6, 0, 4, true, triangles, 0, 0.2}, arc, comm),
                          surface({11, 4, -0.7, 0.7, -0.5, 4.5, false, triangles, primary_ids, 0.2}, arc, comm), Law::tresca);
    const auto nodes = nodes_of(pair, comm);
    for (const Law law : {Law::tresca, Law::bonded}) {
      pair.options.law = law;
      const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
      ASSERT_EQ(rows.rows.size(), 3U * 40U);
      for (const auto& row : rows.rows)
        for (int axis = 0; axis < 3; ++axis) {
          double both = 0, secondary = 0, shift = 0;
          for (const auto& e : row.entries) {
            const double part = e.coefficient * Point(Point::Unit(axis).cross(nodes.at(e.node)))[e.component];
            both += part;
            if (e.component == axis) shift += e.coefficient;
            if (e.node < primary_ids) secondary += axis == 1 ? part : e.component == 1 ? e.coefficient : 0;
          }
          EXPECT_NEAR(shift, 0, 1e-11);
          EXPECT_NEAR(both, 0, 1e-10) << "axis " << axis << (row.is_normal ? ", normal" : ", tangent");
          if (row.is_normal) {
            EXPECT_NEAR(secondary, 0, 1e-9) << "axis " << axis;
          }
        }
    }
  }
}

TEST(Mortar, FarAndFacingAwayNeverMeet)
{
  const Communicator comm;
  const auto at = [](double z) { return [z](double x, double y) { return Point(x, y, z); }; };
  const auto count = [&](const Pair& pair) {
    return comm.sum(static_cast<long long>(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm).nodes.size()));
  };
  const auto below = surface({4, 4, 0, 1, 0, 1, true}, at(0), comm);
  EXPECT_EQ(count(make_pair(below, surface({4, 4, 0, 1, 0, 1, false, false, primary_ids}, at(0.2), comm), Law::frictionless)),
            25);
  EXPECT_EQ(count(make_pair(below, surface({4, 4, 0, 1, 0, 1, false, false, primary_ids}, at(0.6), comm), Law::frictionless)), 0);
  EXPECT_EQ(count(make_pair(below, surface({4, 4, 0, 1, 0, 1, true, false, primary_ids}, at(0.2), comm), Law::frictionless)), 0);
  auto far = make_pair(below, surface({4, 4, 0, 1, 0, 1, false, false, primary_ids}, at(0.6), comm), Law::frictionless);
  far.options.search_distance = 1;
  EXPECT_EQ(count(far), 25);
}

// Rows as plain numbers, in an order that does not depend on the ranks.
std::vector<std::vector<double>> sorted_rows(const constraint::Contacts& contacts, const Communicator& comm)
{
  std::vector<std::vector<double>> result;
  for (const auto& row : gather_rows(contacts, comm).rows) {
    result.push_back(
        {static_cast<double>(row.node), row.normal[0], row.normal[1], row.normal[2], row.area, row.weight, row.bound});
    for (const auto& e : row.entries)
      result.back().insert(result.back().end(), {static_cast<double>(e.node), static_cast<double>(e.component), e.coefficient});
  }
  std::sort(result.begin(), result.end());
  return result;
}

// A small cap over a part of a wavy sheet, of which only what is near is gathered: what that is depends on the ranks.
TEST(Mortar, RowsDependOnTheRanksInNoBit)
{
  const auto sheet = [](double x, double y) { return Point(x, y, 0.1 * std::sin(5 * x + 3 * y)); };
  const auto cap = [&](double x, double y) { return Point(x, y, sheet(x, y)[2] + 0.004 + 0.1 * (x - 1) * (x - 1)); };
  const auto rows = [&](const std::string& discretization, const Communicator& comm) {
    auto pair = make_pair(surface({9, 7, 0.8, 1.23, 0.7, 1.1, false, false, primary_ids, 0.2}, cap, comm),
                          surface({40, 40, 0, 2, 0, 2, true, true}, sheet, comm), Law::coulomb);
    pair.options.search_distance = 0.05;
    pair.options.discretization = discretization;
    return sorted_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  };
  const Communicator all, alone(MPI_COMM_SELF);
  for (const char* discretization : {"mortar", "node_to_segment"}) {
    const auto expected = rows(discretization, alone);
    EXPECT_EQ(expected.size(), 3U * 80U);
    EXPECT_EQ(rows(discretization, all), expected);
  }
}

// Two halves that are bonded at x = 1 and pressed on a plate at z = 0, where nodes 2, 5 and 8 are on both surfaces of the first
// one.
TEST(Mortar, SeamsHaveNoMultipliersWhereTheyEndAtAContact)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto upright = [](double y, double z) { return Point(1, y, z); };
  for (const int high : {1, 3}) {
    auto seam = surface({2, high, 0, 1, 0, 1, true, false, 100}, upright, comm);
    for (auto& node : seam.node_id)
      if (node < 103) node = 2 + 3 * (node - 100);
    const std::vector<Pair> pairs{
        make_pair(seam, surface({3, 4, 0, 1, 0, 1, false, false, 2 * primary_ids}, upright, comm), Law::bonded),
        make_pair(surface({2, 2, 0, 1, 0, 1, false}, flat, comm),
                  surface({3, 3, 0, 2, 0, 1, true, false, primary_ids}, flat, comm), Law::frictionless)};
    const auto contacts = discretize(pairs, {}, fem::Kinematics::solid, comm);
    std::vector<double> count(2, 0.0);  // points of the seam, and those of them at the plate
    for (const auto& point : contacts.nodes) {
      if (point.contact != 0) continue;
      count[0] += 1;
      if (point.node < 100) count[1] += 1;
      double weight = 0;
      for (const auto& e : contacts.rows[point.row]) weight += e.node < primary_ids && e.component == 0 ? e.coefficient : 0;
      EXPECT_NEAR(weight, point.weight, 1e-12);
    }
    comm.sum_in_place(count);
    // The others take over, also those of the upper end alone.
    EXPECT_EQ(count[0], 3.0 * high);
    EXPECT_EQ(count[1], 0);
    double felt = 0;  // of a linear field
    const auto nodes = nodes_of(pairs[0], comm);
    for (const auto& point : contacts.nodes)
      for (std::size_t r = point.row; point.contact == 0 && r <= point.row + 2; ++r) {
        double sum = 0;
        for (const auto& e : contacts.rows[r]) {
          const Point& x = nodes.at(e.node);
          sum += e.coefficient * Point(1 + x[1], 2 * x[2] - x[1], 3 - x[2])[e.component];
        }
        felt = std::max(felt, std::abs(sum));
      }
    EXPECT_LT(comm.max(felt), 1e-12);
  }
}

}  // namespace
}  // namespace mortise::contact
