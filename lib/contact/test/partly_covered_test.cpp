// Faces that cross the border of the other side: where their multipliers act, what gaps and directions they see.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

constexpr auto flat = [](double x, double y) { return Point(x, y, 0); };

Point resultant(const Gathered::Row& row, const std::map<Global, Point>& nodes, bool on_primary)
{
  Point sum = Point::Zero();
  double weight = 0;
  for (const auto& e : row.entries) {
    if ((e.node >= primary_ids) != on_primary || e.component != 2) continue;
    sum += e.coefficient * nodes.at(e.node);
    weight += e.coefficient;
  }
  return sum / weight;
}

class Overhang : public testing::TestWithParam<std::tuple<double, bool, bool>> {};

// A strip of three cells of length 1 lies on one that ends at x = 2 + part: its multipliers push at points up to the edge, and
// none beyond.
TEST_P(Overhang, MultipliersReachTheEdgeAndNoFarther)
{
  const Communicator comm;
  const auto [part, triangles, other_triangles] = GetParam();
  const double edge = 2 + part;
  const auto pair =
      make_pair(surface({3, 2, 0, 3, 0, 1, true, triangles}, flat, comm),
                surface({5, 3, -1, edge, 0, 1, false, other_triangles, primary_ids}, flat, comm), Law::frictionless);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  const auto nodes = nodes_of(pair, comm);
  double farthest = 0, force = 0;
  for (const auto& row : rows.rows) {
    const Point own = resultant(row, nodes, false), other = resultant(row, nodes, true);
    EXPECT_LT((own - other).norm(), 1e-10);
    EXPECT_LT(own[0], edge + 1e-9);
    farthest = std::max(farthest, own[0]);
    force += row.area * row.weight;
    EXPECT_NEAR(row.bound, 0, 1e-12);
  }
  EXPECT_NEAR(farthest, edge, 1e-3);
  EXPECT_NEAR(force, edge, 1e-10);  // of a unit pressure
}

INSTANTIATE_TEST_SUITE_P(Edges, Overhang,
                         testing::Combine(testing::Values(0.1, 1.0 / 3, 2.0 / 3, 0.98), testing::Bool(), testing::Bool()));

// What a constant pressure does to a small plate inside large faces is what it would do to any.
TEST(PartlyCovered, ASmallPlateOnLargeFacesFeelsAllOfAConstantPressure)
{
  const Communicator comm;
  for (const bool triangles : {false, true}) {
    const auto pair = make_pair(surface({3, 3, 0, 3, 0, 3, true, triangles}, flat, comm),
                                surface({2, 2, 1.2, 1.6, 0.9, 1.4, false, false, primary_ids}, flat, comm), Law::frictionless);
    const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
    const auto nodes = nodes_of(pair, comm);
    double force = 0;
    Point moment = Point::Zero();
    for (const auto& row : rows.rows) {
      force += row.area * row.weight;
      moment += row.area * row.weight * resultant(row, nodes, true);
    }
    EXPECT_NEAR(force, 0.2, 1e-10);
    EXPECT_LT((moment / force - Point(1.4, 1.15, 0)).norm(), 1e-9);
  }
}

// One face of second order over [0, 3] x [0, 2], or the half of it below its diagonal, which looks up.
mesh::Surface large_face(mesh::CellType type, const Communicator& comm)
{
  mesh::Surface result;
  if (comm.rank() != 0) return result;
  result.points = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}};
  if (mesh::corner_count(type) == 4) result.points.push_back({0, 2, 0});
  for (const auto& corners : mesh::middles(type)) {
    Point middle = Point::Zero();
    for (const int c : corners) middle += result.points[static_cast<std::size_t>(c)] / static_cast<double>(corners.size());
    result.points.push_back(middle);
  }
  std::vector<Local> nodes;
  for (std::size_t k = 0; k < result.points.size(); ++k) {
    nodes.push_back(static_cast<Local>(k));
    result.node_id.push_back(static_cast<Global>(k));
  }
  result.faces.add(type, nodes);
  result.face_id = {0};
  result.body = {0};
  return result;
}

class Pad : public testing::TestWithParam<std::tuple<mesh::CellType, double>> {};

// A small plate inside a face of second order: multipliers push at its corners, so that it stands until its load passes its edge,
// and the force and moment of a constant pressure are its own.
TEST_P(Pad, MultipliersReachItsCorners)
{
  const Communicator comm;
  const auto [type, x] = GetParam();
  const double size = 0.5, y = 0.2;
  const auto pair =
      make_pair(large_face(type, comm), surface({2, 2, x, x + size, y, y + size, false, false, primary_ids}, flat, comm),
                Law::frictionless);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  const auto nodes = nodes_of(pair, comm);
  double force = 0;
  Point moment = Point::Zero();
  std::array<double, 4> nearest{1, 1, 1, 1};
  for (const auto& row : rows.rows) {
    const Point own = resultant(row, nodes, false), other = resultant(row, nodes, true);
    EXPECT_GT(row.area, 0);
    EXPECT_LT((own - other).norm(), 1e-9);
    EXPECT_LT(std::abs(other[0] - x - size / 2), size / 2 + 1e-9);
    EXPECT_LT(std::abs(other[1] - y - size / 2), size / 2 + 1e-9);
    for (std::size_t c = 0; c < 4; ++c)
      nearest[c] = std::min(nearest[c], (other - Point(x + (c % 2 ? size : 0), y + (c / 2 ? size : 0), 0)).norm());
    force += row.area * row.weight;
    moment += row.area * row.weight * other;
  }
  for (const double distance : nearest) EXPECT_LT(distance, 0.02 * size);
  EXPECT_NEAR(force, size * size, 1e-10);
  EXPECT_LT((moment / force - Point(x + size / 2, y + size / 2, 0)).norm(), 1e-9);
}

// In one facet, across facets, over a middle node.
INSTANTIATE_TEST_SUITE_P(SurfaceNodes, Pad,
                         testing::Combine(testing::Values(mesh::CellType::tri6, mesh::CellType::quad8, mesh::CellType::quad9),
                                          testing::Values(1.1, 1.4, 1.8, 2.3)));

class Base : public testing::TestWithParam<std::tuple<bool, double, double>> {};

// A block that stands on faces without a mesh line in common, turned in their plane or with it: a multiplier pushes at each of
// its corners, so that it stands for every load above its base, and the force and moment of a constant pressure are its own.
TEST_P(Base, MultipliersReachItsCorners)
{
  const Communicator comm;
  const auto [triangles, turned, tilted] = GetParam();
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(tilted, Point(1, 2, 3).normalized()).toRotationMatrix();
  const Point centre(2.8, 2.3, 0);
  const double half = 1.4;
  const auto place = [&, c = std::cos(turned), s = std::sin(turned)](double x, double y) {
    return Point(tilt * (centre + Point(c * x - s * y, s * x + c * y, 0)));
  };
  const auto pair =
      make_pair(surface(
                    {4, 3, 0, 6, 0, 5, true, triangles}, [&](double x, double y) { return Point(tilt * Point(x, y, 0)); }, comm),
                surface({3, 4, -half, half, -half, half, false, false, primary_ids}, place, comm), Law::frictionless);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  const auto nodes = nodes_of(pair, comm);
  const Point up = tilt.col(2);
  double force = 0;
  Point moment = Point::Zero();
  std::array<double, 4> nearest{1, 1, 1, 1};
  for (const auto& row : rows.rows) {
    Point at = Point::Zero();  // on the primary side
    for (const auto& e : row.entries)
      if (e.node >= primary_ids) at -= e.coefficient * up[e.component] / row.weight * nodes.at(e.node);
    for (std::size_t c = 0; c < 4; ++c)
      nearest[c] = std::min(nearest[c], (at - place(c % 2 ? half : -half, c / 2 ? half : -half)).norm());
    force += row.area * row.weight;
    moment += row.area * row.weight * at;
  }
  for (const double distance : nearest) EXPECT_LT(distance, 1e-6);
  EXPECT_NEAR(force, 4 * half * half, 1e-9);
  EXPECT_LT((moment / force - tilt * centre).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Corners, Base, testing::Combine(testing::Bool(), testing::Values(0.0, 0.5), testing::Values(0.0, 0.8)));

class CrossingBorders : public testing::TestWithParam<std::tuple<mesh::CellType, mesh::CellType, double>> {};

// Rectangles turned against each other, each of which hangs over edges of the other: a multiplier pushes at every corner of what
// they have in common, also where their borders cross, and none outside. So blocks stand up to there, and no farther.
TEST_P(CrossingBorders, MultipliersReachCrossingsOfBothBorders)
{
  const Communicator comm;
  const auto [own, other, turned] = GetParam();
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turned, Point::UnitZ()).toRotationMatrix();
  const Point shift(0.37, 0.21, 0);
  const auto make = [&](mesh::CellType type, Grid grid, const Eigen::Matrix3d& rotate, const Point& by) {
    grid.triangles = mesh::corner_count(type) == 3;
    auto side = surface(grid, flat, comm);
    if (mesh::first_order(type) != type) side = second_order(side, type, Eigen::Matrix3d::Identity(), grid.first_id);
    for (auto& x : side.points) x = rotate * x + by;
    return side;
  };
  const Grid grid{3, 2, -1.7, 1.7, -1.1, 1.1, true}, base{2, 3, -1.3, 1.3, -1.6, 1.6, false, false, primary_ids};
  const auto pair = make_pair(make(own, grid, Eigen::Matrix3d::Identity(), Point::Zero()), make(other, base, rotation, shift),
                              Law::frictionless);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  const auto nodes = nodes_of(pair, comm);

  // The lines of both borders, as unit normals to the inside and distances.
  std::vector<Eigen::Vector3d> lines{{1, 0, 1.7}, {-1, 0, 1.7}, {0, 1, 1.1}, {0, -1, 1.1}};
  for (const auto& [x, y, far] : {std::tuple(1, 0, 1.3), {-1, 0, 1.3}, {0, 1, 1.6}, {0, -1, 1.6}}) {
    const Point normal = rotation * Point(x, y, 0);
    lines.emplace_back(normal[0], normal[1], far - normal.dot(shift));
  }
  const auto depth = [&](const Point& x) {
    double least = 10;
    for (const auto& line : lines) least = std::min(least, line.dot(Eigen::Vector3d(x[0], x[1], 1)));
    return least;
  };
  std::vector<Point> places;
  for (const auto& row : rows.rows) {
    places.push_back(resultant(row, nodes, true));
    EXPECT_LT((places.back() - resultant(row, nodes, false)).norm(), 1e-9);
    EXPECT_GT(depth(places.back()), -1e-9);
  }
  int corners = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector3d meet = lines[i].cross(lines[j]);
      if (std::abs(meet[2]) < 1e-9) continue;
      const Point corner(meet[0] / meet[2], meet[1] / meet[2], 0);
      if (depth(corner) < -1e-9) continue;
      ++corners;
      double nearest = 10;
      for (const auto& place : places) nearest = std::min(nearest, (place - corner).norm());
      EXPECT_LT(nearest, 1e-6) << corner.transpose();
    }
  EXPECT_GT(corners, 4);
}

INSTANTIATE_TEST_SUITE_P(Bases, CrossingBorders,
                         testing::Combine(testing::Values(mesh::CellType::tri3, mesh::CellType::quad4, mesh::CellType::tri6,
                                                          mesh::CellType::quad8, mesh::CellType::quad9),
                                          testing::Values(mesh::CellType::tri6, mesh::CellType::quad4),
                                          testing::Values(0.3, 0.9)));

// In a plane, nodes along x at y = 0; the first of the secondary side and all of the primary one cannot move along x.
mesh::Surface line(const std::vector<double>& x, bool up, Global first_id, const Communicator& comm)
{
  mesh::Surface result;
  if (comm.rank() != 0) return result;
  for (std::size_t n = 0; n < x.size(); ++n) {
    result.points.push_back({x[n], 0, 0});
    result.node_id.push_back(first_id + static_cast<Global>(n));
    if (n == 0) continue;
    const auto end = static_cast<Local>(n), begin = end - 1;
    result.faces.add(mesh::CellType::line2, up ? std::vector<Local>{end, begin} : std::vector<Local>{begin, end});
    result.face_id.push_back(first_id + static_cast<Global>(n));
    result.body.push_back(0);
  }
  return result;
}

// A cell beside a plane of symmetry on a held anvil that ends at x = `edge`: along x the point there feels `edge` times the
// displacement of the cell's other node, beside 1 - `edge` times that of the one in the plane. Below a tenth no row feels it.
TEST(PartlyCovered, NoFrictionInAPlaneAcrossWhatSupportsOfBothSidesHold)
{
  const Communicator comm;
  for (const auto& [edge, slips] : {std::pair{0.05, false}, {0.1, false}, {0.3, true}}) {
    const auto pair = make_pair(line({0, 1, 2}, true, 0, comm), line({-1, edge}, false, primary_ids, comm), Law::coulomb);
    std::vector<constraint::PrescribedDof> prescribed;
    if (comm.root())
      for (const Global node : {Global{0}, primary_ids, primary_ids + 1}) prescribed.push_back({node, 0, 0, 0});
    const auto contacts = discretize(std::vector<Pair>{pair}, prescribed, fem::Kinematics::plane_strain, comm);
    long long points = 0, tangents = 0;
    for (const auto& point : contacts.nodes) {
      ++points;
      for (std::size_t t = 0; t < point.tangents.size(); ++t) tangents += !contacts.rows[point.row + 1 + t].empty();
    }
    EXPECT_EQ(comm.sum(points), 2) << edge;
    EXPECT_EQ(comm.sum(tangents), slips ? 1 : 0) << edge;
  }
}

// A shaft in a bush that is shorter: the gap of the circles also where faces of the shaft cross the bush's rim.
TEST(PartlyCovered, GapsAtTheRimAreThoseOfTheSmoothSurfaces)
{
  const Communicator comm;
  const auto arc = [](double radius) {
    return [radius](double x, double y) { return Point(radius * std::sin(x), y, radius * std::cos(x)); };
  };
  for (const bool triangles : {false, true}) {
    const auto pair =
        make_pair(surface({8, 4, -0.6, 0.6, -2, 2, true, triangles}, arc(10), comm),
                  surface({9, 3, -0.6, 0.6, -1.3, 1.6, false, triangles, primary_ids}, arc(10.03), comm), Law::frictionless);
    const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
    EXPECT_GE(rows.rows.size(), 27U);
    for (const auto& row : rows.rows) EXPECT_NEAR(row.bound / row.weight, 0.03, 3e-4);
  }
}

// A curved side on a flat one is pushed along the flat one's normal, whichever carries the multipliers.
TEST(PartlyCovered, DirectionsAreThoseOfTheFlatterSide)
{
  const Communicator comm;
  const auto curved = [](double x, double y) { return Point(x, y, 10 - std::sqrt(100 - x * x)); };
  const auto directions = [&](const mesh::Surface& secondary, const mesh::Surface& primary) {
    auto pair = make_pair(secondary, primary, Law::frictionless);
    pair.options.search_distance = 1;
    double tilt = 0;
    for (const auto& row : gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows)
      tilt = std::max(tilt, std::hypot(row.normal[0], row.normal[1]));
    return tilt;
  };
  EXPECT_LT(directions(surface({8, 2, -2, 2, 0, 1, false}, curved, comm),
                       surface({5, 3, -3, 3, 0, 1, true, false, primary_ids}, flat, comm)),
            1e-7);
  EXPECT_LT(directions(surface({5, 3, -3, 3, 0, 1, true}, flat, comm),
                       surface({8, 2, -2, 2, 0, 1, false, false, primary_ids}, curved, comm)),
            1e-7);
}

// Coordinates of the nodes at which a bond of a side of 12 x 10 cells of length 1 has multipliers, and the force of a unit
// pressure.
struct MultiplierNodes {
  std::set<double> x, y;
  double force = 0;
};
MultiplierNodes bonded_to(const Grid& other, bool triangles, const Communicator& comm)
{
  const auto pair =
      make_pair(surface({12, 10, 0, 12, 0, 10, true, triangles}, flat, comm), surface(other, flat, comm), Law::bonded);
  const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm);
  const auto nodes = nodes_of(pair, comm);
  MultiplierNodes result;
  for (const auto& row : rows.rows) {
    if (!row.is_normal) continue;
    result.x.insert(nodes.at(row.node)[0]);
    result.y.insert(nodes.at(row.node)[1]);
    result.force += row.area * row.weight;
    double sum = 0;
    for (const auto& e : row.entries) sum += e.coefficient;
    EXPECT_NEAR(sum, 0, 1e-12);
  }
  return result;
}

// A bond to a smaller side is no wider than that: nodes past its border leave their multipliers to others, and nothing of a
// constant pressure is lost.
TEST(PartlyCovered, ABondHasNoMultipliersPastTheBorder)
{
  const Communicator comm;
  for (const bool triangles : {false, true}) {
    const auto found = bonded_to({3, 2, 2.6, 7.3, 3.3, 6.6, false, triangles, primary_ids}, triangles, comm);
    EXPECT_EQ(found.x, (std::set<double>{3, 4, 5, 6, 7}));
    EXPECT_EQ(found.y, (std::set<double>{4, 5, 6}));
    EXPECT_NEAR(found.force, 4.7 * 3.3, 1e-10);
  }
}

// A single row of nodes would be a hinge.
TEST(PartlyCovered, ABondToAStripOverOneRowOfNodesKeepsThoseBesideIt)
{
  const Communicator comm;
  for (const bool triangles : {false, true}) {
    const auto found = bonded_to({4, 1, 2.6, 7.3, 3.6, 4.4, false, triangles, primary_ids}, triangles, comm);
    EXPECT_EQ(found.y, (std::set<double>{3, 4, 5}));
    EXPECT_NEAR(found.force, 4.7 * 0.8, 1e-10);
  }
}

class Flat : public testing::TestWithParam<mesh::CellType> {};

// Rounding of coordinates decides about nothing: the rows of flat faces are those of the same faces turned in space.
TEST_P(Flat, FacesTurnedInSpaceHaveTheSameRows)
{
  const Communicator comm;
  const bool triangles = GetParam() == mesh::CellType::tri6;
  const Grid own{4, 3, 0, 4, 0, 3, true, triangles}, other{3, 2, 0, 4, 0, 3, false, false, primary_ids};
  std::map<Global, Gathered::Row> before;
  for (const double degrees : {0.0, 15.0, 40.0, 70.0}) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(degrees * std::acos(-1.0) / 180, Point(1, 1, degrees == 15 ? 0 : 0.3).normalized()).toRotationMatrix();
    const auto pair =
        make_pair(second_order(surface(own, flat, comm), GetParam(), rotation, 0),
                  second_order(surface(other, flat, comm), mesh::CellType::quad8, rotation, primary_ids), Law::frictionless);
    const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows;
    double area = 0;
    for (const auto& row : rows) {
      area += row.area;
      EXPECT_EQ(row.bound, 0);
      EXPECT_NEAR(row.weight, 1, 1e-12);
      const auto [at, first] = before.try_emplace(row.node, row);
      EXPECT_EQ(first, degrees == 0);
      EXPECT_NEAR(row.area, at->second.area, 1e-12) << degrees << " degrees, node " << row.node;
      EXPECT_LT((row.normal - rotation * Point(0, 0, 1)).norm(), 1e-12);
    }
    EXPECT_EQ(rows.size(), before.size());
    EXPECT_NEAR(area, 12, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Faces, Flat, testing::Values(mesh::CellType::tri6, mesh::CellType::quad8, mesh::CellType::quad9));

}  // namespace
}  // namespace mortise::contact
