#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>

#include "base/error.hpp"
#include "fem/loads.hpp"
#include "fem/stiffness.hpp"
#include "fem/stress.hpp"
#include "mesh/blocks.hpp"

namespace mortise::fem {
namespace {

const Material steel{200, 0.3, 2.0, 0};

// A block whose inner nodes are moved at random, so that no cell is regular.
mesh::Mesh distorted(const std::string& element, int dimension)
{
  mesh::Options options;
  mesh::BlockOptions block;
  block.cells = {3, 3, dimension == 3 ? 3 : 0};
  block.element = element;
  options.blocks["box"] = block;
  auto mesh = mesh::generate(options, dimension, 0, {0, 0, 0}, mesh::grid_of(options, dimension, 0));
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  for (auto& p : mesh.points)
    for (int c = 0; c < dimension; ++c)
      if (p[c] > 1e-9 && p[c] < 1 - 1e-9) p[c] += shift(generator);
  return mesh;
}

struct Case {
  std::string element;
  Kinematics kinematics;
};

class Elements : public testing::TestWithParam<Case> {
 protected:
  int dimension() const { return GetParam().kinematics == Kinematics::solid ? 3 : 2; }
};

TEST_P(Elements, RigidMotionsAndNothingElseHaveNoEnergy)
{
  const auto mesh = distorted(GetParam().element, dimension());
  const auto lower = stiffness(mesh, steel, GetParam().kinematics);
  const Eigen::MatrixXd k = lower.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd::Identity(lower.cols(), lower.cols());
  const auto r = rigid_motions(mesh.points, dimension());
  EXPECT_LT((r.transpose() * r - Eigen::MatrixXd::Identity(r.cols(), r.cols())).norm(), 1e-13);
  EXPECT_LT((k * r).norm(), 1e-12 * k.norm());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k);
  EXPECT_LT(std::abs(eigen.eigenvalues()[r.cols() - 1]), 1e-10 * k.norm());
  EXPECT_GT(eigen.eigenvalues()[r.cols()], 1e-5 * k.norm());
}

TEST_P(Elements, LinearFieldsHaveTheirConstantStress)
{
  const auto mesh = distorted(GetParam().element, dimension());
  const int d = dimension();
  Eigen::Matrix3d gradient;
  gradient << 0.01, 0.02, -0.01, 0.005, -0.02, 0.03, 0.01, -0.015, 0.025;
  if (d == 2) gradient.row(2).setZero(), gradient.col(2).setZero();
  Eigen::VectorXd u(static_cast<Eigen::Index>(mesh.node_count()) * d);
  for (std::size_t n = 0; n < mesh.node_count(); ++n) u.segment(static_cast<Eigen::Index>(n) * d, d) = (gradient * mesh.points[n]).head(d);
  Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double mu = 200 / 2.6, lambda = 200 * 0.3 / (1.3 * 0.4);
  if (GetParam().kinematics == Kinematics::plane_stress) strain(2, 2) = -0.3 / 0.7 * (strain(0, 0) + strain(1, 1));
  const Eigen::Matrix3d s = lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * mu * strain;
  const Stress expected = (Stress() << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)).finished();
  const auto field = stresses(mesh, steel, GetParam().kinematics, u);
  for (Eigen::Index n = 0; n < field.nodal_sums.rows(); ++n)
    EXPECT_LT((field.nodal_sums.row(n).head(6).transpose() / field.nodal_sums(n, 6) - expected).norm(), 1e-11);
  EXPECT_NEAR(field.cell_von_mises[0], von_mises(expected), 1e-11);

  // Inside, a constant stress leaves no force on any node (the patch test).
  const auto k = stiffness(mesh, steel, GetParam().kinematics);
  const Eigen::VectorXd f = k.selfadjointView<Eigen::Lower>() * u;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const auto inner = mesh.points[n].head(d).array();
    if (inner.minCoeff() < 1e-9 || inner.maxCoeff() > 1 - 1e-9) continue;
    EXPECT_LT(f.segment(static_cast<Eigen::Index>(n) * d, d).norm(), 1e-12 * f.norm());
  }
}

TEST_P(Elements, LoadsAddUpToTheirResultants)
{
  const auto mesh = distorted(GetParam().element, dimension());
  const int d = dimension();
  const auto total = [&](const Eigen::VectorXd& f) {
    Point sum = Point::Zero();
    for (Eigen::Index i = 0; i < f.size(); ++i) sum[i % d] += f[i];
    return sum;
  };
  Eigen::VectorXd f = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.node_count()) * d);
  add_pressure(mesh, 1, d, 3.0, f);  // xmax
  EXPECT_LT((total(f) - Point(-3, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(area(mesh, 1, d), 1, 1e-12);
  f.setZero();
  add_traction(mesh, 2, d, Point(1, 2, d == 3 ? 3 : 0), f);
  EXPECT_LT((total(f) - Point(1, 2, d == 3 ? 3 : 0)).norm(), 1e-12);
  f.setZero();
  add_acceleration(mesh, d, 2.0, Point(0, -10, 0), f);
  EXPECT_LT((total(f) - Point(0, -20, 0)).norm(), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(All, Elements,
                         testing::Values(Case{"hex8", Kinematics::solid}, Case{"tet4", Kinematics::solid}, Case{"prism6", Kinematics::solid},
                                         Case{"quad4", Kinematics::plane_strain}, Case{"tri3", Kinematics::plane_strain}, Case{"quad4", Kinematics::plane_stress}),
                         [](const auto& info) { return info.param.element + (info.param.kinematics == Kinematics::plane_stress ? "_plane_stress" : ""); });

TEST(Stiffness, NamesACellThatIsTurnedInsideOut)
{
  auto mesh = distorted("hex8", 3);
  std::swap(mesh.points[static_cast<std::size_t>(mesh.cells[13][0])], mesh.points[static_cast<std::size_t>(mesh.cells[13][6])]);
  try {
    stiffness(mesh, steel, Kinematics::solid);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    EXPECT_NE(std::string(error.what()).find("cell "), std::string::npos);
  }
}

TEST(VonMises, UniaxialShearAndHydrostatic)
{
  EXPECT_NEAR(von_mises((Stress() << 5, 0, 0, 0, 0, 0).finished()), 5, 1e-14);
  EXPECT_NEAR(von_mises((Stress() << 0, 0, 0, 2, 0, 0).finished()), 2 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(von_mises((Stress() << 7, 7, 7, 0, 0, 0).finished()), 0, 1e-14);
}

}  // namespace
}  // namespace mortise::fem
