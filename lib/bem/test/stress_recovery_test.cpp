#include "bem/stress_recovery.hpp"

#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace mortise::bem {
namespace {

using namespace test;

// Forces of the field on the nodes, n x 3, exact for linear stresses: those at the centre of gravity of each phi.
Eigen::MatrixXd forces_on_nodes(const Panels& panels, const Field& field)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(panels.node_count(), 3);
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (int k = 0; k < 3; ++k) {
      const Point centre = (3 * panels.middle(p) + panels.corner(p, k)) / 4;
      result.row(panels.corners[p][static_cast<std::size_t>(k)]) +=
          panels.area[p] / 3 * (hooke(steel(), field.gradient(centre)) * panels.normal[p]).transpose();
    }
  return result;
}

// Square root of the mean square error of the nodal stresses, of the recovery and of area-weighted means of the panels' stresses.
struct RecoveryErrors {
  double recovered, averaged;
};
RecoveryErrors recovery_errors(const Panels& panels, const Field& field, bool with_forces = false)
{
  const Eigen::VectorXd u = field.nodal(panels), t = field.tractions(panels, steel()), area = nodal_areas(panels);
  const Eigen::MatrixXd stresses = panel_stresses(panels, steel(), u, t);
  const auto fits = recovered_stresses(
      panels, steel(),
      with_forces ? SurfaceValues{u, t, forces_on_nodes(panels, field), nodal_normals(panels)} : SurfaceValues{u, t});
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(panels.node_count(), 6);
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) means.row(c) += panels.area[p] / 3 * stresses.row(static_cast<Eigen::Index>(p));
  RecoveryErrors result{0, 0};
  for (Eigen::Index n = 0; n < panels.node_count(); ++n) {
    const fem::Stress exact = components(hooke(steel(), field.gradient(panels.points[static_cast<std::size_t>(n)])));
    result.recovered += (fits[static_cast<std::size_t>(n)].constant - exact).squaredNorm();
    result.averaged += (means.row(n).transpose() / area[n] - exact).squaredNorm();
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
    for (const bool with_forces : {false, true})
      EXPECT_LT(recovery_errors(panels, bending(steel().poisson_ratio), with_forces).recovered, 1e-12);
}

TEST(StressRecovery, SlopeOfALinearStress)
{
  const auto panels = box({3, 2, 4}, {2, 1, 1.5});
  const auto field = bending(steel().poisson_ratio);
  const Eigen::VectorXd u = field.nodal(panels), t = field.tractions(panels, steel());
  Eigen::Matrix<double, 6, 3> slope = Eigen::Matrix<double, 6, 3>::Zero();
  slope(0, 2) = steel().young_modulus;
  const StressRecovery recovery(panels, steel());
  for (Local n = 0; n < panels.node_count(); ++n) EXPECT_LT((recovery.at(n, {u, t}).slope - slope).norm(), 1e-12) << n;
}

TEST(StressRecovery, PointForceOutsideIsOfSecondOrderAndBetterThanMeans)
{
  const auto field = kelvin(steel(), {0.7, 0.4, 2.5}, {0.3, -0.5, 1});
  const auto coarse = recovery_errors(box({8, 4, 6}, {2, 1, 1.5}), field),
             fine = recovery_errors(box({16, 8, 12}, {2, 1, 1.5}), field);
  EXPECT_LT(fine.recovered, coarse.recovered / 3);
  EXPECT_LT(fine.recovered, fine.averaged / 1.5);
}

// Any displacements, tractions and forces: stresses turn with the body.
TEST(StressRecovery, HasNoAxesOfItsOwn)
{
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()).toRotationMatrix();
  const auto turned = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    return (turn * v.reshaped(3, v.size() / 3)).reshaped();
  };
  const auto still = box({3, 2, 4}, {2, 1, 1.5});
  auto points = still.points;
  for (auto& x : points) x = turn * x;
  const auto moved = make_panels(std::move(points), still.corners);
  std::srand(1);
  const Eigen::VectorXd u = Eigen::VectorXd::Random(3 * still.node_count()), t = Eigen::VectorXd::Random(3 * still.size()),
                        turned_u = turned(u), turned_t = turned(t);
  const Eigen::MatrixXd forces = Eigen::MatrixXd::Random(still.node_count(), 3);
  const auto here = recovered_stresses(still, steel(), {u, t, forces, nodal_normals(still)}),
             there = recovered_stresses(moved, steel(), {turned_u, turned_t, forces * turn.transpose(), nodal_normals(moved)});
  for (std::size_t n = 0; n < here.size(); ++n) {
    const auto& s = here[n].constant;
    const Eigen::Matrix3d tensor = (Eigen::Matrix3d() << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]).finished();
    EXPECT_LT((components(turn * tensor * turn.transpose()) - there[n].constant).norm(), 1e-10 * s.norm()) << n;
  }
}

// As at the sharp edges of a cut: one panel in five has a traction that is half as large again. Forces make up for it.
TEST(StressRecovery, ForcesMakeUpForPoorTractions)
{
  const auto panels = sphere(1, 3);
  const auto field = kelvin(steel(), {0.7, 0.4, 2.5}, {0.3, -0.5, 1});
  const Eigen::VectorXd u = field.nodal(panels), exact = field.tractions(panels, steel());
  Eigen::VectorXd t = exact;
  for (Eigen::Index p = 0; p < panels.size(); p += 5) t.segment<3>(3 * p) *= 1.5;
  const auto off = [&](const SurfaceValues& values) {
    const auto fits = recovered_stresses(panels, steel(), values);
    double sum = 0;
    for (std::size_t n = 0; n < fits.size(); ++n)
      sum += (fits[n].constant - components(hooke(steel(), field.gradient(panels.points[n])))).squaredNorm();
    return std::sqrt(sum / static_cast<double>(fits.size()));
  };
  const double without = off({u, t});
  EXPECT_GT(without, 3 * off({u, exact}));
  EXPECT_LT(off({u, t, forces_on_nodes(panels, field), nodal_normals(panels)}), 0.5 * without);
}

}  // namespace
}  // namespace mortise::bem
