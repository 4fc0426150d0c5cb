#include "bem/stress_recovery.hpp"

#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace mortise::bem {
namespace {

using namespace test;

// Square root of the mean square error of the nodal stresses, of the recovery and of area-weighted means of the panels' stresses.
struct RecoveryErrors {
  double recovered, averaged;
};
RecoveryErrors recovery_errors(const Panels& panels, const Field& field)
{
  const Eigen::VectorXd u = field.nodal(panels), t = field.tractions(panels, steel());
  const Eigen::MatrixXd sums = nodal_sums(panels, steel(), u, t), stresses = panel_stresses(panels, steel(), u, t);
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(panels.node_count(), 6);
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) means.row(c) += panels.area[p] / 3 * stresses.row(static_cast<Eigen::Index>(p));
  RecoveryErrors result{0, 0};
  for (Eigen::Index n = 0; n < panels.node_count(); ++n) {
    const fem::Stress exact = components(hooke(steel(), field.gradient(panels.points[static_cast<std::size_t>(n)])));
    result.recovered += (sums.row(n).head<6>().transpose() / sums(n, 6) - exact).squaredNorm();
    result.averaged += (means.row(n).transpose() / sums(n, 6) - exact).squaredNorm();
  }
  const auto count = static_cast<double>(panels.node_count());
  return {std::sqrt(result.recovered / count), std::sqrt(result.averaged / count)};
}

TEST(SurfaceStress, ConstantStressOnEveryPanel)
{
  const Eigen::Matrix3d gradient = (Eigen::Matrix3d() << 0.3, 0.2, -0.5, 0.7, -0.4, 0.1, 0.25, 0.9, 0.6).finished();
  const auto panels = sphere(1.5, 2);
  const auto field = linear(gradient);
  const Eigen::VectorXd u = field.nodal(panels), t = field.tractions(panels, steel());
  const fem::Stress exact = components(hooke(steel(), gradient));
  const Eigen::MatrixXd stresses = panel_stresses(panels, steel(), u, t);
  for (Eigen::Index p = 0; p < panels.size(); ++p) EXPECT_LT((stresses.row(p).transpose() - exact).norm(), 1e-12);
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    EXPECT_LT((panel_gradient(panels, steel(), p, u, t) - gradient).norm(), 1e-12);
}

TEST(SurfaceStress, HookesLaw)
{
  // sigma_xx = E, with contraction nu
  const double nu = steel().poisson_ratio;
  const Eigen::Matrix3d pulled = Eigen::Vector3d(1, -nu, -nu).asDiagonal();
  EXPECT_LT((components(hooke(steel(), pulled)) - (fem::Stress() << steel().young_modulus, 0, 0, 0, 0, 0).finished()).norm(),
            1e-15);
  Eigen::Matrix3d sheared = Eigen::Matrix3d::Zero();
  sheared(1, 2) = 1;
  EXPECT_NEAR(components(hooke(steel(), sheared))[4], shear_modulus(steel()), 1e-15);
}

TEST(StressRecovery, LinearStressesAreExactOnFacesEdgesAndCorners)
{
  for (const auto& panels :
       {box({3, 2, 4}, {2, 1, 1.5}, [](double s) { return s * (1 + s) / 2; }), sphere(1, 1), box({1, 1, 1}, {1, 1, 1})})
    EXPECT_LT(recovery_errors(panels, bending(steel().poisson_ratio)).recovered, 1e-12);
}

TEST(StressRecovery, SlopeOfALinearStress)
{
  const auto panels = box({3, 2, 4}, {2, 1, 1.5});
  const auto field = bending(steel().poisson_ratio);
  const Eigen::VectorXd u = field.nodal(panels), t = field.tractions(panels, steel());
  Eigen::Matrix<double, 6, 3> slope = Eigen::Matrix<double, 6, 3>::Zero();
  slope(0, 2) = steel().young_modulus;
  const StressRecovery recovery(panels, steel());
  for (Local n = 0; n < panels.node_count(); ++n) EXPECT_LT((recovery.at(n, u, t).slope - slope).norm(), 1e-12) << n;
}

TEST(StressRecovery, PointForceOutsideIsOfSecondOrderAndBetterThanMeans)
{
  const auto field = kelvin(steel(), {0.7, 0.4, 2.5}, {0.3, -0.5, 1});
  const auto coarse = recovery_errors(box({8, 4, 6}, {2, 1, 1.5}), field),
             fine = recovery_errors(box({16, 8, 12}, {2, 1, 1.5}), field);
  EXPECT_LT(fine.recovered, coarse.recovered / 3);
  EXPECT_LT(fine.recovered, fine.averaged / 1.5);
}

}  // namespace
}  // namespace mortise::bem
