#include "constraint/normals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/error.hpp"
#include "constraint/supports.hpp"
#include "mesh/shape_functions.hpp"
#include "nodes.hpp"

namespace mortise::constraint {
namespace {

using mesh::CellType;

Point vector(const std::array<double, 3>& v)
{
  return {v[0], v[1], v[2]};
}

// Every ranks-th face stands on this rank, with its nodes.
mesh::Surface surface(CellType type, const std::vector<std::vector<Local>>& faces, const std::vector<Point>& points,
                      const Communicator& comm)
{
  mesh::Surface result;
  for (std::size_t n = 0; n < points.size(); ++n) result.node_id.push_back(static_cast<Global>(n));
  result.points = points;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (static_cast<int>(f) % comm.size() != comm.rank()) continue;
    result.faces.add(type, faces[f]);
    result.face_id.push_back(static_cast<Global>(f));
  }
  return result;
}

std::vector<Support> along_normal(std::initializer_list<double> values)
{
  std::vector<Support> supports;
  for (const double value : values) {
    supports.emplace_back().boundary = "side " + std::to_string(supports.size());
    supports.back().normal = value;
  }
  return supports;
}

TEST(Normals, OfAPlaneAreItsOwnInEveryFace)
{
  const Communicator comm;
  Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()).toRotationMatrix();
  for (const auto type : {CellType::tri3, CellType::quad4, CellType::tri6, CellType::quad8, CellType::quad9}) {
    std::vector<Point> points;
    std::vector<Local> nodes;
    for (const auto& at : mesh::shape_functions(type).nodes()) {
      nodes.push_back(static_cast<Local>(points.size()));
      points.emplace_back(rotation * Point(at[0] + 0.2 * at[1] * at[1], at[1], 4));
    }
    const auto normals = node_normals(along_normal({0}), std::vector{surface(type, {nodes}, points, comm)}, comm);
    EXPECT_EQ(comm.sum(static_cast<long long>(normals.size())), static_cast<long long>(points.size()));
    for (const auto& n : normals) {
      EXPECT_EQ(n.node % comm.size(), comm.rank());
      EXPECT_LT((vector(n.direction) - rotation.col(2)).norm(), 1e-13);
    }
  }
}

TEST(Normals, OfUnevenChordsAreThoseOfTheCircle)
{
  const Communicator comm;
  std::vector<Point> points;
  std::vector<std::vector<Local>> faces;
  for (const double angle : {0.1, 0.3, 0.35, 0.6, 0.7}) points.emplace_back(std::cos(angle), std::sin(angle), 0);
  for (Local n = 0; n + 1 < 5; ++n) faces.push_back({n, n + 1});
  for (const auto& n : node_normals(along_normal({0}), std::vector{surface(CellType::line2, faces, points, comm)}, comm))
    if (n.node > 0 && n.node < 4) {
      EXPECT_LT((vector(n.direction) - points[static_cast<std::size_t>(n.node)]).norm(), 1e-13);
    }
}

// Two chords that meet at 90 degrees, both off the axes, moved along their normals by 2 and -1: the node between them is
// prescribed in both, and goes where it must.
TEST(Normals, ANodeOnAnEdgeIsHeldAcrossBothSides)
{
  const Communicator comm;
  const Point along(std::cos(0.4), std::sin(0.4), 0), across(-along[1], along[0], 0);
  const std::vector<Point> points{along, Point::Zero(), 2 * across};
  const std::vector<mesh::Surface> sides{surface(CellType::line2, {{0, 1}}, points, comm),
                                         surface(CellType::line2, {{1, 2}}, points, comm)};
  const auto supports = along_normal({2, -1});
  const auto normals = node_normals(supports, sides, comm);
  const auto skew_supports = skew_support_rows(supports, normals, {}, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(skew_supports.size())), 4);
  for (const auto& i : skew_supports) {
    if (i.node != 1) continue;
    // A chord with the direction t has the outward normal (t_y, -t_x): across and along.
    EXPECT_NEAR(vector(i.direction).dot(2 * across - along), i.value, 1e-13);
  }
}

// At one node: y prescribed at 0.3, and normals at 60 degrees to y and to each other in space.
TEST(Normals, ObliqueSupportsAreMadeOrthogonalAndShareTheirForces)
{
  const Communicator comm(MPI_COMM_SELF);
  auto supports = along_normal({0.7, -0.2});
  supports.push_back({"component", {std::nullopt, 0.3, std::nullopt}});
  const Point first = Point(std::sqrt(0.75), 0.5, 0), second = Point(0.2, 0.5, std::sqrt(0.71));
  const std::vector<NodeDirection> normals{{4, 0, {first[0], first[1], first[2]}, 0.7},
                                           {4, 1, {second[0], second[1], second[2]}, -0.2}};
  const std::vector<PrescribedDof> prescribed{{4, 1, 0.3, 2}};
  const auto skew_supports = skew_support_rows(supports, normals, prescribed, comm);
  ASSERT_EQ(skew_supports.size(), 2U);
  Eigen::Matrix3d directions;
  directions << 0, 1, 0, vector(skew_supports[0].direction).transpose(), vector(skew_supports[1].direction).transpose();
  EXPECT_LT((directions * directions.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-13);
  const Point u = directions.inverse() * Point(0.3, skew_supports[0].value, skew_supports[1].value);
  EXPECT_NEAR(first.dot(u), 0.7, 1e-13);
  EXPECT_NEAR(second.dot(u), -0.2, 1e-13);
  const std::vector<Point> own{first, second, Point(0, 1, 0)};
  for (const auto& i : skew_supports) {
    Point sum = Point::Zero();
    for (int k = 0; k < i.share_count; ++k) {
      const auto& share = i.shares[static_cast<std::size_t>(k)];
      sum += vector(share.part);
      EXPECT_LT(vector(share.part).cross(own[static_cast<std::size_t>(share.support)]).norm(), 1e-13);  // along its own normal
    }
    EXPECT_LT((sum - vector(i.direction)).norm(), 1e-13);
  }
}

TEST(Normals, AlongAnAxisAreComponents)
{
  const auto supports = along_normal({0.5});
  std::vector<NodeDirection> normals{{1, 0, {0, -1, 0}, 0.5}, {2, 0, {0.6, 0.8, 0}, 0.5}};
  const auto prescribed = take_axis_aligned(normals);
  ASSERT_EQ(prescribed.size(), 1U);
  EXPECT_EQ(prescribed[0].component, 1);
  EXPECT_EQ(prescribed[0].value, -0.5);
  ASSERT_EQ(normals.size(), 1U);
  EXPECT_EQ(normals[0].node, 2);
  EXPECT_EQ(dirichlet_rows(supports, anywhere({{}}), 3, Communicator(MPI_COMM_SELF), prescribed).size(), 1U);
}

TEST(Normals, ContradictionNamesBothBoundaries)
{
  const Communicator comm(MPI_COMM_SELF);
  std::vector<NodeDirection> normals{{3, 0, {0.6, 0.8, 0}, 0.5}, {3, 1, {-0.6, -0.8, 0}, -0.5}};
  EXPECT_EQ(skew_support_rows(along_normal({0.5, -0.5}), normals, {}, comm).size(), 1U);
  normals[1].value = 0.5;
  try {
    skew_support_rows(along_normal({0.5, 0.5}), normals, {}, comm);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    EXPECT_NE(std::string(error.what()).find("\"side 1\""), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("\"side 0\""), std::string::npos) << error.what();
  }
}

// A node beside the axis and one on it, under a radial, a tangential and an axial displacement by a formula.
TEST(LocalAxes, HoldNodesAlongTheCylinder)
{
  const Communicator comm;
  const Point axis = Point(1, 2, 2) / 3, point(5, -1, 2);
  deck::AxesOptions options;
  options.axis = {1, 2, 2};
  options.point = {5, -1, 2};
  std::vector<Support> supports(1);
  supports[0].boundary = "bore";
  supports[0].axes.emplace(options, false);
  supports[0].displacement = {deck::Formula(0.0), deck::Formula("2 * x"), deck::Formula(0.5)};
  const Point off = axis.unitOrthogonal();
  const std::vector<SupportNodes> nodes{{{3, 8}, {Point(point + 4 * axis + 0.1 * off), Point(point - 7 * axis)}}};
  const auto found = axes_directions(supports, nodes, 3, 1e-9, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(found.size())), 6);
  for (const auto& d : found) {
    EXPECT_EQ(d.node % comm.size(), comm.rank());
    const double along = std::abs(vector(d.direction).dot(axis));
    if (d.node == 8) {
      EXPECT_NEAR(d.value, along > 0.5 ? 0.5 : 0.0, 1e-15);
      EXPECT_NEAR(along, along > 0.5 ? 1 : 0, 1e-13);
      continue;
    }
    if (std::abs(vector(d.direction).dot(off)) > 0.5)
      EXPECT_EQ(d.value, 0);
    else if (along > 0.5)
      EXPECT_EQ(d.value, 0.5);
    else {
      EXPECT_LT((vector(d.direction) - axis.cross(off)).norm(), 1e-12);
      EXPECT_NEAR(d.value, 2 * nodes[0].at[0][0], 1e-12);
    }
  }
  EXPECT_EQ(comm.sum(static_cast<long long>(skew_support_rows(supports, found, {}, comm).size())), 6);
  supports[0].displacement[0] = deck::Formula(0.1);
  EXPECT_THROW(axes_directions(supports, nodes, 3, 1e-9, comm), Error);
}

}  // namespace
}  // namespace mortise::constraint
