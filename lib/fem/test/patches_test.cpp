// Polynomials on patches: exact for what they hold, and no worse where a body is one cell thick.
#include "fem/patches.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "fem/stress.hpp"
#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

Eigen::MatrixXd patch_means(const Block& block, const Constitution& constitution, Kinematics kinematics, const Eigen::VectorXd& u)
{
  const auto patches = patch_sums(block.mesh, constitution, kinematics, u, 1, largest_order(block.mesh));
  const auto sums = patch_stresses(block.mesh, constitution.materials, kinematics, patches, 1);
  return sums.leftCols(6).array().colwise() / sums.col(6).array();
}

double largest_difference(const Eigen::MatrixXd& nodal, const Block& block, const Eigen::Matrix3d& constant,
                          const std::function<Eigen::Matrix3d(const Point&)>& gradient, Kinematics kinematics)
{
  double result = 0;
  for (std::size_t n = 0; n < block.mesh.node_count(); ++n) {
    const Eigen::Matrix3d exact = hooke(constant + gradient(block.mesh.points[n]), steel(), kinematics);
    const Stress expected = (Stress() << exact.diagonal(), exact(0, 1), exact(1, 2), exact(0, 2)).finished();
    result = std::max(result, (nodal.row(static_cast<Eigen::Index>(n)).transpose() - expected).cwiseAbs().maxCoeff());
  }
  return result;
}

TEST(Patches, ConstantStressIsExactAlsoInOneCell)
{
  for (const auto& [name, kinematics] : all_cases())
    for (const auto& cells : {std::array{3, 3, 3}, std::array{4, 1, 1}, std::array{1, 1, 1}}) {
      if (cells[1] == 1 && (name == "quad4" || name == "hex8" || name == "prism6")) continue;  // nothing is recovered
      Block block(name, cells, {1, 2, 1.5});
      block.distort(0.07, true);
      const auto gradient = some_gradient(block.dimension);
      const auto u = sample(block.mesh, block.dimension, [&](const Point& x) { return Point(gradient * x); });
      const auto nodal = patch_means(block, {steel()}, kinematics, u);
      const auto none = [](const Point&) { return Eigen::Matrix3d(Eigen::Matrix3d::Zero()); };
      EXPECT_LT(largest_difference(nodal, block, gradient, none, kinematics), 1e-9 * steel().young_modulus) << name;
    }
}

// The few samples of a corner's cells are next to determine a polynomial of second order where edges are slightly curved.
TEST(Patches, SlightlyCurvedEdgesChangeLittle)
{
  for (const std::string name : {"tet10", "prism15", "tri6", "hex20"}) {
    Block block(name, {4, 3, 2}, {2, 1, 1});
    const auto kinematics = block.dimension == 2 ? Kinematics::plane_strain : Kinematics::solid;
    const auto error = [&] {
      const auto u = sample(block.mesh, block.dimension,
                            [](const Point& x) { return Point(x[0] * x[0] * x[1], std::sin(2 * x[0]), x[1] * x[2]); });
      return squared_errors(block.mesh, steel(), kinematics, u, patch_means(block, {steel()}, kinematics, u)).sum();
    };
    const double straight = error();
    for (auto& x : block.mesh.points) x[1] += 0.01 * std::sin(2 * x[0]) + 0.01 * (x[2] - 0.5) * (x[0] - 1);
    EXPECT_NEAR(error(), straight, 0.2 * straight) << name;
  }
}

// u = (x^2 / 2 + x y, -y^2, 0): cells of second order have it, and a stress that is linear, everywhere. The interpolant of first
// order in bricks and rectangles has that stress in the middle of each.
TEST(Patches, LinearStressIsExactUpToTheBorder)
{
  for (const auto& [name, kinematics] : all_cases()) {
    if (!name.starts_with("hex") && !name.starts_with("quad")) continue;  // a simplex in a corner may have no node inside
    const Block block(name, {4, 3, 2}, {1, 2, 1.5});
    const auto u =
        sample(block.mesh, block.dimension, [](const Point& x) { return Point(x[0] * x[0] / 2 + x[0] * x[1], -x[1] * x[1], 0); });
    const auto gradient = [](const Point& x) {
      Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
      h(0, 0) = x[0] + x[1], h(0, 1) = x[0], h(1, 1) = -2 * x[1];
      return h;
    };
    const auto nodal = patch_means(block, {steel()}, kinematics, u);
    EXPECT_LT(largest_difference(nodal, block, Eigen::Matrix3d::Zero(), gradient, kinematics), 1e-6 * steel().young_modulus)
        << name;
  }
}

}  // namespace
}  // namespace mortise::fem
