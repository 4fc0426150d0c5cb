#include "fem/loads.hpp"

#include <gtest/gtest.h>

#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

const std::vector<std::string> sides{"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};

std::vector<std::string> sides_of(const Block& block)
{
  return {sides.begin(), sides.begin() + 2 * block.dimension};
}

Point resultant(const Eigen::VectorXd& f, int d)
{
  Point sum = Point::Zero();
  for (Eigen::Index i = 0; i < f.size(); i += d) sum.head(d) += f.segment(i, d);
  return sum;
}

Point moment(const mesh::Mesh& mesh, const Eigen::VectorXd& f, int d)
{
  Point sum = Point::Zero();
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    Point force = Point::Zero();
    force.head(d) = f.segment(static_cast<Eigen::Index>(n) * d, d);
    sum += mesh.points[n].cross(force);
  }
  return sum;
}

Eigen::VectorXd no_load(const Block& block)
{
  return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(block.mesh.node_count()) * block.dimension);
}

TEST(Loads, PressureAndTractionOnOneSideHaveTheirResultantAndMoment)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 2, 2}, {1, 2, 3});
    const int d = block.dimension;
    const double width = d == 3 ? 3 : 1;
    const int side = block.boundary("xmax");
    const Point centre(1, 1, d == 3 ? 1.5 : 0);
    EXPECT_NEAR(area(block.mesh, side, kinematics), 2 * width, 1e-12);

    auto f = no_load(block);
    add_pressure(block.mesh, side, kinematics, 5, f);
    const Point push(-5 * 2 * width, 0, 0);
    EXPECT_LT((resultant(f, d) - push).norm(), 1e-12) << name;
    EXPECT_LT((moment(block.mesh, f, d) - centre.cross(push)).norm(), 1e-11) << name;

    f = no_load(block);
    const Point traction(1, -2, d == 3 ? 4 : 0);
    add_traction(block.mesh, side, kinematics, traction, f);
    const Point force = 2 * width * traction;
    EXPECT_LT((resultant(f, d) - force).norm(), 1e-12) << name;
    EXPECT_LT((moment(block.mesh, f, d) - centre.cross(force)).norm(), 1e-11) << name;
    for (std::size_t n = 0; n < block.mesh.node_count(); ++n) {
      const double loaded = f.segment(static_cast<Eigen::Index>(n) * d, d).norm();
      EXPECT_EQ(loaded > 0, block.mesh.points[n][0] > 0.99) << name;
    }
  }
}

// p = 5 (1 + y) on x = 1, 0 < y < 2: the moment of what varies is that of a formula, on faces of one integration point as well.
TEST(Loads, PressuresThatVaryHaveTheirMoment)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 2, 2}, {1, 2, 3});
    const int d = block.dimension;
    const double width = d == 3 ? 3 : 1;
    auto f = no_load(block);
    add_pressure(
        block.mesh, block.boundary("xmax"), kinematics, [](const Point& x) { return 5 * (1 + x[1]); }, f);
    EXPECT_LT((resultant(f, d) - Point(-20 * width, 0, 0)).norm(), 1e-11) << name;
    EXPECT_LT((moment(block.mesh, f, d) - width * Point(0, d == 3 ? -30 : 0, 70.0 / 3)).norm(), 1e-11) << name;
  }
}

// Moments about a boundary's own centre are those of the same boundary at the origin, wherever it lies.
TEST(Loads, MomentsAboutABoundaryKeepTheirFiguresFarFromTheOrigin)
{
  for (const auto& [name, kinematics] : all_cases()) {
    if (kinematics == Kinematics::axisymmetric) continue;
    Block block(name, {3, 2, 2}, {1, 2, 3});
    const int d = block.dimension, side = block.boundary("xmax");
    const Point centre(1, 1, d == 3 ? 1.5 : 0), away(1e6, -2e6, d == 3 ? 1e6 : 0);
    const auto here = moments(block.mesh, side, kinematics, centre);
    const auto nodes = nodal_moments(block.mesh, side, kinematics, centre);
    for (auto& p : block.mesh.points) p += away;
    const auto there = moments(block.mesh, side, kinematics, centre + away);
    EXPECT_LT(there.first.norm(), 1e-8) << name;
    EXPECT_LT((there.second - here.second).norm(), 1e-8) << name;
    EXPECT_LT((nodal_moments(block.mesh, side, kinematics, centre + away) - nodes).norm(), 1e-8) << name;
  }
}

// The same pressure all around, warped faces included: no resultant, no moment, and the work -p div(u) V in a linear
// displacement.
TEST(Loads, PressureAllAroundIsInBalance)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 3, 2});
    block.distort(0.06, true);
    const int d = block.dimension;
    auto f = no_load(block);
    for (const auto& side : sides_of(block)) add_pressure(block.mesh, block.boundary(side), kinematics, 2.5, f);
    EXPECT_GT(f.norm(), 0.1);
    EXPECT_LT(resultant(f, d).norm(), 1e-13) << name;
    EXPECT_LT(moment(block.mesh, f, d).norm(), 1e-13) << name;
    // The volume from the weight of the block.
    auto weight = no_load(block);
    add_acceleration(block.mesh, kinematics, 1, Point(1, 0, 0), weight);
    const double volume = resultant(weight, d)[0];
    const auto gradient = some_gradient(d);
    const auto u = sample(block.mesh, d, [&](const Point& x) { return Point(gradient * x); });
    EXPECT_NEAR(f.dot(u), -2.5 * gradient.trace() * volume, 1e-14) << name;
  }
}

TEST(Loads, WeightActsAtTheCentreOfMass)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 3, 2}, {1, 2, 3});
    const auto type = block.mesh.cells.type[0];
    if (type == mesh::first_order(type)) block.distort(0.07);  // inside, where it does not change the block
    const int d = block.dimension;
    auto f = no_load(block);
    const Point acceleration(0.3, -9.81, d == 3 ? 2 : 0);
    add_acceleration(block.mesh, kinematics, 7.5, acceleration, f);
    const Point force = 7.5 * block.measure() * acceleration;
    EXPECT_LT((resultant(f, d) - force).norm(), 1e-12 * force.norm()) << name;
    const Point centre(0.5, 1, d == 3 ? 1.5 : 0);
    EXPECT_LT((moment(block.mesh, f, d) - centre.cross(force)).norm(), 1e-12 * force.norm()) << name;
  }
}

// Equilibrium of a homogeneous stress: K u is the load of the tractions s n on all sides, at every node.
TEST(Loads, TractionsBalanceTheStiffnessOfALinearField)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 3, 3}, {1, 2, 1.5});
    block.distort(0.07);
    const int d = block.dimension;
    const auto gradient = some_gradient(d);
    const Eigen::Matrix3d stress = hooke(gradient, steel(), kinematics);
    auto f = no_load(block);
    for (int axis = 0; axis < d; ++axis)
      for (int side = 0; side < 2; ++side)
        add_traction(block.mesh, block.boundary(sides[static_cast<std::size_t>(2 * axis + side)]), kinematics,
                     Point((side == 0 ? -1 : 1) * stress.col(axis)), f);
    const auto u = sample(block.mesh, d, [&](const Point& x) { return Point(gradient * x); });
    EXPECT_LT((dense(stiffness(block.mesh, steel(), kinematics)) * u - f).norm(), 1e-12 * f.norm()) << name;
  }
}

}  // namespace
}  // namespace mortise::fem
