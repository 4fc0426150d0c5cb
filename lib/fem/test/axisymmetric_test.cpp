// Rings: what the hoop strain adds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/dense.hpp"
#include "fem/loads.hpp"
#include "fem/stress.hpp"
#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

struct Ring {
  std::string element;
  Formulation formulation;
};

class Axisymmetric : public testing::TestWithParam<Ring> {
 protected:
  static constexpr auto kinematics = Kinematics::axisymmetric;
  static constexpr double inner = 0.7, outer = 1.7, height = 2;

  static Block ring(std::array<int, 3> cells, double distortion)
  {
    Block block(GetParam().element, cells, {outer - inner, height, 0});
    if (distortion > 0) block.distort(distortion);
    for (auto& p : block.mesh.points) p[0] += inner;
    return block;
  }
};
INSTANTIATE_TEST_SUITE_P(Cells, Axisymmetric,
                         testing::Values(Ring{"tri3", Formulation::standard}, Ring{"quad4", Formulation::standard},
                                         Ring{"tri6", Formulation::standard}, Ring{"quad8", Formulation::standard},
                                         Ring{"quad9", Formulation::standard}, Ring{"quad4", Formulation::bbar}),
                         [](const auto& info) {
                           return info.param.element + (info.param.formulation == Formulation::bbar ? "_bbar" : "");
                         });

// One cell moves freely along the axis, and in no other way.
TEST_P(Axisymmetric, TheKernelOfOneCellIsTheMotionAlongTheAxis)
{
  const Block block = ring({1, 1, 0}, 0);
  mesh::Mesh one;  // the first cell alone: a rectangle is two triangles
  one.cell_id = {0};
  std::vector<Local> local;
  for (const Local node : block.mesh.cells[0]) {
    local.push_back(static_cast<Local>(one.points.size()));
    one.points.push_back(block.mesh.points[static_cast<std::size_t>(node)]);
  }
  one.cells.add(block.mesh.cells.type[0], local);
  const auto k = dense(stiffness(one, steel(), kinematics, GetParam().formulation));
  const auto r = rigid_motions(one.points, kinematics);
  ASSERT_EQ(r.cols(), 1);
  EXPECT_NEAR(r.norm(), 1, 1e-14);
  EXPECT_LT((k * r).norm(), 1e-13 * k.norm());
  const auto values = dense::symmetric_eigenvalues(k);
  EXPECT_GT(values[1], 1e-4 * values.maxCoeff());
}

// u = (a r, b z): the same strain everywhere. Its energy, its stress, and no force on an inner node of a distorted mesh; on the
// surface the forces are those of the tractions.
TEST_P(Axisymmetric, PassesThePatchTest)
{
  const Block block = ring({3, 3, 0}, 0.07);
  const double a = 0.02, b = -0.03;
  const Eigen::Matrix3d gradient = Eigen::Vector3d(a, b, a).asDiagonal();  // across the plane u_r / r
  const Eigen::Matrix3d stress = hooke(gradient, steel(), Kinematics::solid);
  const auto u = sample(block.mesh, 2, [&](const Point& x) { return Point(a * x[0], b * x[1], 0); });
  const auto k = dense(stiffness(block.mesh, steel(), kinematics, GetParam().formulation));
  const Eigen::VectorXd force = k * u;
  const double volume = std::numbers::pi * (outer * outer - inner * inner) * height;
  const double density = (stress.array() * gradient.array()).sum();
  EXPECT_NEAR(u.dot(force), density * volume, 1e-12 * density * volume);

  Eigen::VectorXd load = Eigen::VectorXd::Zero(force.size());
  const std::vector<std::string> sides{"xmin", "xmax", "ymin", "ymax"};
  for (int side = 0; side < 4; ++side)
    add_traction(block.mesh, block.boundary(sides[static_cast<std::size_t>(side)]), kinematics,
                 Point((side % 2 == 0 ? -1 : 1) * stress.col(side / 2)), load);
  EXPECT_LT((force - load).norm(), 1e-12 * load.norm());

  const auto field = stresses(block.mesh, steel(), kinematics, u, GetParam().formulation);
  for (Eigen::Index n = 0; n < field.nodal_sums.rows(); ++n) {
    const Eigen::VectorXd s = field.nodal_sums.row(n).head(6) / field.nodal_sums(n, 6);
    EXPECT_NEAR(s[0], stress(0, 0), 1e-9);
    EXPECT_NEAR(s[1], stress(1, 1), 1e-9);
    EXPECT_NEAR(s[2], stress(2, 2), 1e-9);
    EXPECT_NEAR(s[3], 0, 1e-9);
  }
}

// Pappus: areas and volumes of the whole turn, inclined sides as well.
TEST_P(Axisymmetric, LoadsAreThoseOfTheWholeTurn)
{
  Block block = ring({2, 2, 0}, 0);
  for (auto& p : block.mesh.points) p[0] += 0.25 * p[1];  // cones inside and outside
  const double slant = std::hypot(0.25 * height, height), middle = outer + 0.125 * height;
  EXPECT_NEAR(area(block.mesh, block.boundary("xmax"), kinematics), 2 * std::numbers::pi * middle * slant, 1e-12);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(block.mesh.node_count()) * 2);
  add_acceleration(block.mesh, kinematics, 3, Point(0, -2, 0), f);
  double weight = 0;
  for (Eigen::Index i = 1; i < f.size(); i += 2) weight += f[i];
  const double centroid = 0.5 * (inner + outer) + 0.125 * height;
  EXPECT_NEAR(weight, -6 * 2 * std::numbers::pi * centroid * (outer - inner) * height, 1e-11);
  f.setZero();
  add_pressure(block.mesh, block.boundary("ymax"), kinematics, 5, f);
  double push = 0;
  for (Eigen::Index i = 1; i < f.size(); i += 2) push += f[i];
  const double top = outer + 0.25 * height, bottom = inner + 0.25 * height;
  EXPECT_NEAR(push, -5 * std::numbers::pi * (top * top - bottom * bottom), 1e-11);
}

}  // namespace
}  // namespace mortise::fem
