// Where rows of flat sides act, however their meshes and borders lie: what each multiplier pushes on one side it pushes on the
// other, at one place, which both sides cover.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

using mesh::CellType;

// Force and place of a row on one side; it pushes along `axis`.
std::pair<double, Point> action(const Gathered::Row& row, const std::map<Global, Point>& nodes, bool on_primary,
                                const Point& axis)
{
  Point sum = Point::Zero();
  double force = 0;
  for (const auto& e : row.entries) {
    if ((e.node >= primary_ids) != on_primary) continue;
    const double part = e.coefficient * axis[e.component];
    sum += part * nodes.at(e.node);
    force += part;
  }
  return {force, sum / force};
}

// What the sides have in common: a convex polygon, counter-clockwise in the plane of x and y.
using Corners = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

// The part of it where (x - at).inward >= 0.
Corners clip(const Corners& corners, const Eigen::Vector2d& at, const Eigen::Vector2d& inward)
{
  Corners result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double da = (a - at).dot(inward), db = (b - at).dot(inward);
    if (da >= 0) result.push_back(a);
    if (da * db < 0) result.push_back(a + da / (da - db) * (b - a));
  }
  return result;
}

double area_of(const Corners& c)
{
  double twice = 0;
  for (std::size_t i = 0; i < c.size(); ++i) twice += cross(c[i] - c[0], c[(i + 1) % c.size()] - c[0]);
  return twice / 2;
}

Eigen::Vector2d centre_of(const Corners& c)
{
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < c.size(); ++i)
    sum += cross(c[i] - c[0], c[(i + 1) % c.size()] - c[0]) / 2 * (c[i] + c[(i + 1) % c.size()] + c[0]) / 3;
  return sum / area_of(c);
}

double outside(const Corners& c, const Point& x)
{
  double farthest = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Eigen::Vector2d edge = c[(i + 1) % c.size()] - c[i];
    farthest = std::max(farthest, cross(x.head<2>() - c[i], edge) / edge.norm());
  }
  return farthest;
}

mesh::Surface side(const Grid& grid, CellType type, const Eigen::Matrix3d& rotation, const Point& origin,
                   const Communicator& comm)
{
  auto result = surface(
      grid, [](double x, double y) { return Point(x, y, 0); }, comm);
  if (mesh::first_order(type) != type) result = second_order(result, type, Eigen::Matrix3d::Identity(), grid.first_id);
  for (auto& x : result.points) x = rotation * x + origin;
  return result;
}

// How far the rows, each of length 1, are from depending on each other: the least pivot of their orthogonalization.
double independence(const std::vector<Gathered::Row>& rows, const std::map<Global, Point>& nodes)
{
  Eigen::MatrixXd transposed =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(nodes.size()), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const auto& e : rows[r].entries)
      if (e.component == 2)
        transposed(static_cast<Eigen::Index>(std::distance(nodes.begin(), nodes.find(e.node))), static_cast<Eigen::Index>(r)) +=
            e.coefficient;
  transposed.colwise().normalize();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(transposed);
  return factor.matrixQR().diagonal().cwiseAbs().minCoeff();
}

class Places : public testing::TestWithParam<std::tuple<CellType, CellType>> {};

// A block of 3 x 3 stands anywhere on a plate of 6 x 5, or over its edges; turned, or as its meshes lie.
TEST_P(Places, BothSidesArePushedAtOnePlaceThatBothCover)
{
  const Communicator comm;
  const auto [own, other] = GetParam();
  std::mt19937 generator(7);
  const auto random = [&] { return std::uniform_real_distribution<double>(0, 1)(generator); };
  for (int i = 0; i < 12; ++i) {
    const double turned = i % 4 == 3 ? random() : 0, over = i % 3 == 2 ? 2.9 : 0;
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turned, Point(0, 0, 1)).toRotationMatrix();
    const double x = i == 5 ? 0.2 : random(), y = random();
    const Point origin(1 + over + x, 1 + (i % 2 == 1 ? over : 0) + y, 0);
    const bool plate_first = i % 2 == 0;
    const auto triangles = [](CellType t) { return mesh::corner_count(t) == 3; };
    const Grid plate{6, 5, 0, 6, 0, 5, plate_first, triangles(plate_first ? own : other), plate_first ? 0 : primary_ids};
    const Grid block{3, 3, 0, 3, 0, 3, !plate_first, triangles(plate_first ? other : own), plate_first ? primary_ids : 0};
    const auto lower = side(plate, plate_first ? own : other, Eigen::Matrix3d::Identity(), Point::Zero(), comm);
    const auto upper = side(block, plate_first ? other : own, rotation, origin, comm);
    Corners common{{0, 0}, {6, 0}, {6, 5}, {0, 5}};
    for (const int k : {0, 1, 2, 3}) {
      const Point corner(k == 1 || k == 2 ? 3 : 0, k > 1 ? 3 : 0, 0);
      const Point inward(k == 3 ? 1 : k == 1 ? -1 : 0, k == 0 ? 1 : k == 2 ? -1 : 0, 0);
      common = clip(common, Point(rotation * corner + origin).head<2>(), Point(rotation * inward).head<2>());
    }
    const auto pair = plate_first ? make_pair(lower, upper, Law::frictionless) : make_pair(upper, lower, Law::frictionless);
    const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::solid, comm), comm).rows;
    const auto nodes = nodes_of(pair, comm);
    double force = 0;
    Point moment = Point::Zero();
    for (const auto& row : rows) {
      const auto [push, at] = action(row, nodes, false, row.normal);
      const auto [back, there] = action(row, nodes, true, row.normal);
      EXPECT_NEAR(push, -back, 1e-10);
      EXPECT_LT((at - there).norm(), 1e-9) << "place " << i;
      EXPECT_LT(outside(common, at), 1e-9) << "place " << i << ", node " << row.node;
      force += row.area * push;
      moment += row.area * push * at;
    }
    EXPECT_NEAR(force, area_of(common), 1e-9) << "place " << i;  // of a pressure of 1
    EXPECT_GT(independence(rows, nodes), 5e-4) << "place " << i;
    EXPECT_LT((moment.head<2>() / force - centre_of(common)).norm(), 1e-9) << "place " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Faces, Places,
    testing::Combine(testing::Values(CellType::tri3, CellType::tri6, CellType::quad4, CellType::quad8, CellType::quad9),
                     testing::Values(CellType::tri3, CellType::tri6, CellType::quad4, CellType::quad8, CellType::quad9)));

// A line along x of cells of length 1, which looks up or down.
mesh::Surface line(int cells, double from, bool second, bool up, Global first_id, const Communicator& comm)
{
  mesh::Surface result;
  if (comm.rank() != 0) return result;
  const int per_cell = second ? 2 : 1;
  for (int k = 0; k <= per_cell * cells; ++k) {
    result.points.push_back({from + static_cast<double>(k) / per_cell, 0, 0});
    result.node_id.push_back(first_id + k);
  }
  for (int k = 0; k < cells; ++k) {
    std::vector<Local> nodes{per_cell * k, per_cell * (k + 1)};
    if (up) std::swap(nodes[0], nodes[1]);
    if (second) nodes.push_back(2 * k + 1);
    result.faces.add(second ? CellType::line3 : CellType::line2, nodes);
    result.face_id.push_back(first_id + k);
    result.body.push_back(0);
  }
  return result;
}

TEST(Places, OnLinesAsWell)
{
  const Communicator comm;
  std::mt19937 generator(7);
  for (int i = 0; i < 40; ++i) {
    const bool lower_first = i % 2 == 0, own_second = i / 2 % 2 == 0, other_second = i / 4 % 2 == 0;
    const double from = std::uniform_real_distribution<double>(0, 5)(generator), end = std::min(from + 3, 6.0);
    const bool lower_second = lower_first ? own_second : other_second, upper_second = lower_first ? other_second : own_second;
    const auto lower = line(6, 0, lower_second, true, lower_first ? 0 : primary_ids, comm);
    const auto upper = line(3, from, upper_second, false, lower_first ? primary_ids : 0, comm);
    const auto pair = lower_first ? make_pair(lower, upper, Law::frictionless) : make_pair(upper, lower, Law::frictionless);
    const auto rows = gather_rows(discretize(std::vector<Pair>{pair}, {}, fem::Kinematics::plane_strain, comm), comm).rows;
    const auto nodes = nodes_of(pair, comm);
    double force = 0, moment = 0;
    for (const auto& row : rows) {
      const auto [push, at] = action(row, nodes, false, row.normal);
      const auto [back, there] = action(row, nodes, true, row.normal);
      EXPECT_NEAR(push, -back, 1e-10);
      EXPECT_NEAR(at[0], there[0], 1e-9);
      EXPECT_GT(at[0], from - 1e-9);
      EXPECT_LT(at[0], end + 1e-9);
      force += row.area * push;
      moment += row.area * push * at[0];
    }
    EXPECT_NEAR(force, end - from, 1e-9);
    EXPECT_NEAR(moment / force, (from + end) / 2, 1e-9);
  }
}

}  // namespace
}  // namespace mortise::contact
