// Contact rows judged without any finite element: what they say of rigid motions and linear fields, and what a constant pressure
// does.
#include "contact/mortar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "contact/proximity.hpp"
#include "contact/state.hpp"

namespace mortise::contact {
namespace {

using mesh::CellType;

// A grid of nx x ny faces over [x0, x1] x [y0, y1] at height z(x, y), looking up or down; each rank holds every ranks-th face.
struct Grid {
  int nx, ny;
  double x0, x1, y0, y1;
  bool up;
  bool triangles = false;
  Global first_id = 0;
  double disturb = 0;  // of the inner nodes, part of the cell size
};

template <class Height>
mesh::Surface surface(const Grid& g, const Height& height, const Communicator& comm)
{
  std::vector<Point> points;
  std::mt19937 generator(static_cast<unsigned>(g.nx));
  std::uniform_real_distribution<double> shift(-g.disturb, g.disturb);
  for (int j = 0; j <= g.ny; ++j)
    for (int i = 0; i <= g.nx; ++i) {
      const bool inner = i > 0 && i < g.nx && j > 0 && j < g.ny;
      const double x = g.x0 + (g.x1 - g.x0) * (i + (inner ? shift(generator) : 0)) / g.nx,
                   y = g.y0 + (g.y1 - g.y0) * (j + (inner ? shift(generator) : 0)) / g.ny;
      points.push_back(height(x, y));
    }
  std::vector<std::vector<int>> faces;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const int a = i + (g.nx + 1) * j, b = a + 1, c = b + g.nx + 1, d = a + g.nx + 1;
      if (g.triangles) {
        faces.push_back({a, b, c});
        faces.push_back({a, c, d});
      } else {
        faces.push_back({a, b, c, d});
      }
    }
  mesh::Surface result;
  std::map<int, Local> local;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (static_cast<int>(f) % comm.size() != comm.rank()) continue;
    for (const int n : faces[f]) local.emplace(n, 0);
  }
  for (auto& [n, index] : local) {
    index = static_cast<Local>(result.points.size());
    result.points.push_back(points[static_cast<std::size_t>(n)]);
    result.node_id.push_back(g.first_id + n);
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (static_cast<int>(f) % comm.size() != comm.rank()) continue;
    std::vector<Local> nodes;
    for (const int n : faces[f]) nodes.push_back(local.at(n));
    if (!g.up) std::reverse(nodes.begin(), nodes.end());
    result.faces.add(g.triangles ? CellType::tri3 : CellType::quad4, nodes);
    result.face_id.push_back(g.first_id + static_cast<Global>(f));
    result.body.push_back(0);
  }
  return result;
}

// All points and rows on every rank.
struct Gathered {
  struct Entry {
    Global node;
    int component;
    double coefficient;
  };
  struct Row {
    std::vector<Entry> entries;
    double bound;
    Global node;
    double area, weight;
    Point normal;
    bool is_normal;
  };
  std::vector<Row> rows;
};

Gathered gather_rows(const constraint::Contacts& contacts, const Communicator& comm)
{
  std::vector<double> stream;
  for (const auto& point : contacts.points)
    for (std::size_t r = point.row; r <= point.row + point.tangents.size(); ++r) {
      stream.insert(stream.end(),
                    {static_cast<double>(contacts.rows[r].size()), contacts.rows.bound[r], static_cast<double>(point.node),
                     point.area, point.weight, point.normal[0], point.normal[1], point.normal[2], r == point.row ? 1.0 : 0.0});
      for (const auto& e : contacts.rows[r])
        stream.insert(stream.end(), {static_cast<double>(e.node), static_cast<double>(e.component), e.coefficient});
    }
  stream = comm.all_gather(stream);
  Gathered result;
  for (std::size_t at = 0; at < stream.size();) {
    Gathered::Row row;
    const auto count = static_cast<std::size_t>(stream[at]);
    row.bound = stream[at + 1];
    row.node = static_cast<Global>(stream[at + 2]);
    row.area = stream[at + 3];
    row.weight = stream[at + 4];
    row.normal = Point(stream[at + 5], stream[at + 6], stream[at + 7]);
    row.is_normal = stream[at + 8] == 1;
    at += 9;
    for (std::size_t e = 0; e < count; ++e, at += 3)
      row.entries.push_back({static_cast<Global>(stream[at]), static_cast<int>(stream[at + 1]), stream[at + 2]});
    result.rows.push_back(row);
  }
  return result;
}

constexpr Global primary_ids = 100000;

// Coordinates of every node, whole.
std::map<Global, Point> nodes_of(const Pair& pair, const Communicator& comm)
{
  std::vector<double> flat;
  for (const auto* side : {&pair.secondary, pair.primary.get()})
    for (std::size_t n = 0; n < side->points.size(); ++n)
      flat.insert(flat.end(),
                  {static_cast<double>(side->node_id[n]), side->points[n][0], side->points[n][1], side->points[n][2]});
  std::map<Global, Point> result;
  flat = comm.all_gather(flat);
  for (std::size_t i = 0; i < flat.size(); i += 4)
    result[static_cast<Global>(flat[i])] = Point(flat[i + 1], flat[i + 2], flat[i + 3]);
  return result;
}

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

Pair make_pair(const mesh::Surface& secondary, const mesh::Surface& primary, Law law)
{
  Options options;
  options.law = law;
  return {options, secondary, std::make_shared<const mesh::Surface>(primary)};
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

TEST(Mortar, HeldNodesLeaveTheirPressureToTheOthers)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({4, 4, 0, 1, 0, 1, true}, flat, comm),
                              surface({5, 3, 0, 1, 0, 1, false, false, primary_ids}, flat, comm), Law::tresca);
  std::vector<constraint::Held> held;
  if (comm.root())
    for (const Global node : {0, 5, 10, 15, 20}) {             // x = 0: held along the normal, and along y
      held.push_back({node, 2, 0.5, static_cast<int>(node)});  // each by a support of its own
      held.push_back({node, 1, 0, static_cast<int>(node)});
    }
  if (comm.root()) held.push_back({24, 0, 0, 24});  // one tangential component at a corner
  const auto contacts = discretize(std::vector<Pair>{pair}, held, fem::Kinematics::solid, comm);
  for (const auto& point : contacts.points) {
    EXPECT_NE(point.node % 5, 0);
    if (point.node == 24) {
      ASSERT_EQ(point.tangents.size(), 1U);
      EXPECT_NEAR(std::abs(point.tangents[0][1]), 1, 1e-12);
    }
  }
  const auto rows = gather_rows(contacts, comm);
  std::map<Global, Point> force;
  for (const auto& row : rows.rows)
    if (row.is_normal)
      for (const auto& e : row.entries)
        force.try_emplace(e.node, Point::Zero()).first->second[e.component] += row.area * e.coefficient;
  // What acts on held components goes into their supports, and what these move stands in the bounds.
  std::vector<double> supported(3 * 25, 0.0);
  double shift = 0, expected_shift = 0;
  for (const auto& point : contacts.points) {
    shift += point.gap - contacts.rows.bound[point.row];
    for (const auto& entry : contacts.held) {
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

TEST(Mortar, FarAndFacingAwayNeverMeet)
{
  const Communicator comm;
  const auto at = [](double z) { return [z](double x, double y) { return Point(x, y, z); }; };
  const auto count = [&](const Pair& pair) {
    return comm.sum(static_cast<long long>(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm).points.size()));
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

TEST(NodeToSegment, LinearFieldsPassAndMatchingMeshesGivePairs)
{
  const Communicator comm;
  const auto plane = [](double x, double y) { return Point(x, y, 0.3 * x - 0.2 * y); };
  auto pair = make_pair(surface({5, 4, 0, 1, 0, 1, true, false, 0, 0.2}, plane, comm),
                        surface({3, 7, 0, 1, 0, 1, false, true, primary_ids, 0.2}, plane, comm), Law::bonded);
  pair.options.discretization = "node_to_segment";
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  ASSERT_EQ(rows.rows.size(), 3U * 30U);
  Eigen::Matrix3d gradient;
  gradient << 1, 2, 3, -1, 0.5, 2, 0.3, -2, 1;
  const auto nodes = nodes_of(pair, comm);
  double area = 0;
  for (const auto& row : rows.rows) {
    double jump = 0;
    int own = 0;
    for (const auto& e : row.entries) {
      jump += e.coefficient * (gradient * nodes.at(e.node) + Point(1, 2, 3))[e.component];
      if (e.node < primary_ids) own += e.node == row.node ? 1 : 100;
    }
    EXPECT_NEAR(jump, 0, 1e-12);
    EXPECT_LE(own, 3);
    if (row.is_normal) area += row.area;
  }
  EXPECT_NEAR(area, std::sqrt(1 + 0.09 + 0.04), 1e-10);

  auto matching = make_pair(surface({4, 4, 0, 1, 0, 1, true}, plane, comm),
                            surface({4, 4, 0, 1, 0, 1, false, false, primary_ids}, plane, comm), Law::tresca);
  matching.options.discretization = "node_to_segment";
  const auto places = nodes_of(matching, comm);
  const auto pairs = gather_rows(discretize(std::vector<Pair>{matching}, {}, fem::Kinematics::solid, comm), comm);
  EXPECT_EQ(pairs.rows.size(), 3U * 25U);
  for (const auto& row : pairs.rows)
    for (const auto& e : row.entries)
      EXPECT_TRUE(std::abs(e.coefficient) < 1e-12 || (places.at(e.node) - places.at(row.node)).norm() < 1e-12);
}

TEST(Obstacles, SignedDistances)
{
  using Shape = Obstacle::Shape;
  const Point x(3, 4, 7);
  EXPECT_NEAR(foot({Shape::plane, Point(0, 0, 5), Point::UnitZ(), 0, false}, x).distance, 2, 1e-15);
  EXPECT_NEAR(foot({Shape::cylinder, Point::Zero(), Point::UnitZ(), 4, false}, x).distance, 1, 1e-15);
  EXPECT_NEAR(foot({Shape::cylinder, Point::Zero(), Point::UnitZ(), 4, true}, x).distance, -1, 1e-15);
  EXPECT_LT((foot({Shape::cylinder, Point::Zero(), Point::UnitZ(), 4, true}, x).normal + Point(0.6, 0.8, 0)).norm(), 1e-15);
  EXPECT_NEAR(foot({Shape::sphere, Point(0, 0, 7), Point::UnitY(), 6, true}, x).distance, 1, 1e-15);
  EXPECT_LT((foot({Shape::sphere, Point(0, 0, 7), Point::UnitY(), 6, false}, x).normal - Point(0.6, 0.8, 0)).norm(), 1e-15);
  EXPECT_FALSE(std::isfinite(foot({Shape::sphere, x, Point::UnitY(), 6, false}, x).distance));
}

// A wavy sheet over a plane: rows of single nodes along the plane's normal, with their heights for gaps; areas of the whole
// sheet.
TEST(Obstacles, RowsAreThoseOfNodesAlongTheNormalOfTheObstacle)
{
  const Communicator comm;
  const auto sheet = [](double x, double y) { return Point(x, y, 0.1 * x * x + 0.05 * y); };
  auto pair = make_pair(surface({5, 4, 0, 1, 0, 1, false, false, 0, 0.2}, sheet, comm), {}, Law::coulomb);
  pair.primary = nullptr;
  pair.options.obstacle = Obstacle{Obstacle::Shape::plane, Point(7, 8, -0.01), Point::UnitZ(), 0, false};
  pair.options.interference = 0.005;
  const auto contacts = discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(contacts.points.size())), 30);
  std::vector<double> area{0};
  for (const auto& point : contacts.points) {
    EXPECT_LT((point.normal + Point::UnitZ()).norm(), 1e-15);
    EXPECT_NEAR(point.gap, point.at[2] + 0.01 - 0.005, 1e-14);
    ASSERT_EQ(contacts.rows[point.row].size(), 1U);
    EXPECT_EQ(contacts.rows[point.row][0].node, point.node);
    EXPECT_NEAR(contacts.rows[point.row][0].coefficient, -1, 1e-12);
    area[0] += point.area;
  }
  comm.sum_in_place(area);
  // integral sqrt(1 + (0.2 x)^2 + 0.05^2), x in [0, 1]; facets are smaller by about a twentieth of a per cent.
  EXPECT_NEAR(area[0], 1.00778, 5e-4);
}

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
  constraint::ContactPoint point{0, 7, 0.5, Point(0, 0, 1), {Point(1, 0, 0), Point(0, 1, 0)}, 0};
  const auto slip = state_of(point, false, std::vector<double>{10, 3, 0}, std::vector<double>{0.1, 0.2, 0.0}, 0.1, 3.0, 0);
  EXPECT_EQ(slip.status, Status::slip);
  EXPECT_LT((slip.force_on_secondary - Point(-3, 0, -10)).norm(), 1e-14);
  EXPECT_NEAR(slip.gap, 0, 1e-15);
  EXPECT_EQ(state_of(point, false, std::vector<double>{10, 1, 0}, std::vector<double>{0, 0, 0}, 0, 3.0, 0).status, Status::stick);
  EXPECT_EQ(state_of(point, false, std::vector<double>{1e-6, 0, 0}, std::vector<double>{0, 0, 0}, 0, 3.0, 1e-3).status,
            Status::open);
  EXPECT_EQ(state_of(point, false, std::vector<double>{0, 0, 0}, std::vector<double>{0, 0, 0}, 0.2, 0.0, 0).status, Status::open);
  const auto sums = resultants(std::vector<PointState>{slip}, 1, comm);
  EXPECT_NEAR(sums[0].force[2], -10.0 * comm.size(), 1e-12);
  EXPECT_NEAR(sums[0].max_pressure, 20, 1e-12);
  EXPECT_EQ(sums[0].slip, comm.size());
}

// Scatter that alternates from node to node goes, a constant stays, and so does a slope inside.
TEST(State, RecoveredPressureIsSmooth)
{
  const Communicator comm;
  const auto flat = [](double x, double y) { return Point(x, y, 0); };
  const auto pair = make_pair(surface({4, 4, 0, 1, 0, 1, true}, flat, comm),
                              surface({5, 3, 0, 1, 0, 1, false, false, primary_ids}, flat, comm), Law::frictionless);
  const auto pressure = [](double x, double scatter) { return 10 + x + scatter; };
  std::vector<PointState> points;
  if (comm.root())
    for (Global node = 0; node < 25; ++node) {
      const bool edge_x = node % 5 == 0 || node % 5 == 4, edge_y = node / 5 == 0 || node / 5 == 4;
      PointState point;
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

}  // namespace
}  // namespace mortise::contact
