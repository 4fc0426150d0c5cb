#include "fem/stress.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "fem/quantity.hpp"
#include "fem/symmetry.hpp"
#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

Stress components(const Eigen::Matrix3d& s)
{
  return (Stress() << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)).finished();
}

Eigen::MatrixXd recovered(const StressField& field)
{
  return field.nodal_sums.leftCols(6).array().colwise() / field.nodal_sums.col(6).array();
}

TEST(Stress, VonMisesOfSimpleStates)
{
  EXPECT_DOUBLE_EQ(von_mises((Stress() << -3, 0, 0, 0, 0, 0).finished()), 3);
  EXPECT_DOUBLE_EQ(von_mises((Stress() << 5, 5, 5, 0, 0, 0).finished()), 0);
  for (int shear = 3; shear < 6; ++shear) {
    Stress s = Stress::Zero();
    s[shear] = 2;
    EXPECT_DOUBLE_EQ(von_mises(s), 2 * std::sqrt(3.0));
  }
}

// The mean over all products of mirror images, which are finitely many where planes meet at a part of a half turn.
TEST(Stress, SymmetricOnesAreMeansOfMirrorImages)
{
  const Eigen::Matrix3d q = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Stress stress = (Stress() << 3, -1, 4, 1, -5, 9).finished();
  const auto s = (Eigen::Matrix3d() << 3, 1, 9, 1, -1, -5, 9, -5, 4).finished();
  const auto at = [&](double degrees) {
    const double angle = degrees * M_PI / 180;
    return Point(q * Point(std::cos(angle), std::sin(angle), 0));
  };
  const Point up = q * Point(0, 0, 1);
  for (const std::vector<Point>& normals : {std::vector<Point>{at(20)},
                                            {at(10), at(100)},
                                            {at(10), up, at(100)},
                                            {at(0), at(120)},
                                            {up, at(30), at(165)},
                                            {at(0), at(120), at(240)}}) {
    std::vector<Eigen::Matrix3d> images{Eigen::Matrix3d::Identity()};
    for (std::size_t i = 0; i < images.size(); ++i)
      for (const Point& n : normals) {
        const Eigen::Matrix3d next = (Eigen::Matrix3d::Identity() - 2 * n * n.transpose()) * images[i];
        if (std::none_of(images.begin(), images.end(), [&](const auto& m) { return (m - next).norm() < 1e-9; }))
          images.push_back(next);
      }
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
    for (const auto& m : images) mean += m * s * m.transpose() / static_cast<double>(images.size());
    EXPECT_LT((symmetric_stress(stress, normals) - components(mean)).norm(), 1e-12) << images.size();
  }
  EXPECT_EQ(symmetric_stress(stress, std::vector<Point>{-Point::UnitX()}), (Stress() << 3, -1, 4, 0, -5, 0).finished());
}

// A tensor of known eigenvalues, rotated; pure shear; equal ones.
// The traction across one face changes, those across faces at right angles to it do not.
TEST(Stress, TakesATractionAcrossAFace)
{
  Stress stress;
  stress << 3, -1, 2, 0.5, 0.25, -0.75;
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.7, Point(1, 2, -1).normalized()).toRotationMatrix();
  const auto in_axes = [&](const Stress& s) { return rotated_stress(s, axes.transpose()); };
  Stress expected = in_axes(stress);
  expected[1] = -4;
  EXPECT_LT((in_axes(stress_with_traction(stress, axes.col(1), -4)) - expected).norm(), 1e-14 * expected.norm());
}

TEST(Stress, PrincipalStressesAreSortedEigenvalues)
{
  const Eigen::Matrix3d q = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d exact(7, -1, -4);
  EXPECT_LT((principal_stresses(components(q * exact.asDiagonal() * q.transpose())) - exact).norm(), 1e-13);
  EXPECT_LT((principal_stresses((Stress() << 0, 0, 0, 2, 0, 0).finished()) - Eigen::Vector3d(2, 0, -2)).norm(), 1e-14);
  EXPECT_LT((principal_stresses((Stress() << 5, 5, 5, 0, 0, 0).finished()) - Eigen::Vector3d(5, 5, 5)).norm(), 1e-14);
}

TEST(Quantity, HasTheValueThatItsNameSays)
{
  const Stress s = (Stress() << 1, 2, 3, 4, 5, 6).finished();
  const Point u(7, 8, 9);
  const auto of = [&](const char* name, bool smallest = false) { return value(*quantity(name), smallest, u, s); };
  const char* names[] = {"sxx", "syy", "szz", "sxy", "syz", "sxz", "ux", "uy", "uz"};
  for (int i = 0; i < 9; ++i) EXPECT_EQ(of(names[i]), i + 1);
  EXPECT_DOUBLE_EQ(of("displacement"), std::sqrt(194.0));
  EXPECT_DOUBLE_EQ(of("von_mises"), von_mises(s));
  EXPECT_DOUBLE_EQ(of("principal_stress"), principal_stresses(s)[0]);
  EXPECT_DOUBLE_EQ(of("principal_stress", true), principal_stresses(s)[2]);
  EXPECT_FALSE(quantity("stress"));
}

TEST(Stress, LinearDisplacementHasItsConstantStressEverywhere)
{
  for (const auto& [name, kinematics] : all_cases()) {
    Block block(name, {3, 3, 3}, {1, 2, 1.5});
    block.distort(0.07, true);
    const auto gradient = some_gradient(block.dimension);
    const auto u = sample(block.mesh, block.dimension, [&](const Point& x) { return Point(gradient * x); });
    const Stress expected = components(hooke(gradient, steel(), kinematics));
    const auto field = stresses(block.mesh, steel(), kinematics, u);
    const auto nodal = recovered(field);
    EXPECT_LT((nodal.rowwise() - expected.transpose()).cwiseAbs().maxCoeff(), 1e-11 * expected.norm()) << name;
    EXPECT_LT((field.cell_von_mises.array() - von_mises(expected)).abs().maxCoeff(), 1e-11 * expected.norm()) << name;
    EXPECT_LT(squared_errors(block.mesh, steel(), kinematics, u, nodal).sum(), 1e-18 * expected.norm()) << name;
  }
}

TEST(Stress, KeptStressesGiveTheSameError)
{
  for (const auto formulation : {Formulation::standard, Formulation::bbar})
    for (const auto& [name, kinematics] : all_cases()) {
      Block block(name, {3, 2, 2}, {1, 2, 1.5});
      block.distort(0.07, true);
      const auto u = sample(block.mesh, block.dimension, [](const Point& x) { return Point(x[0] * x[0], x[0] * x[1], 0); });
      PointStresses points;
      const auto nodal = recovered(stresses(block.mesh, steel(), kinematics, u, formulation, {}, 1, &points));
      const double expected = squared_errors(block.mesh, steel(), kinematics, u, nodal, formulation).sum();
      EXPECT_NEAR(squared_error(block.mesh, steel(), kinematics, points, nodal), expected, 1e-12 * expected) << name;
    }
}

TEST(Stress, FormulationsFindTheSameConstantStress)
{
  for (const auto formulation : {Formulation::bbar, Formulation::incompatible})
    for (const auto& [name, kinematics] : {Case{"hex8", Kinematics::solid}, Case{"quad4", Kinematics::plane_strain}}) {
      Block block(name, {3, 3, 3}, {1, 2, 1.5});
      block.distort(0.07, true);
      const auto gradient = some_gradient(block.dimension);
      const auto u = sample(block.mesh, block.dimension, [&](const Point& x) { return Point(gradient * x); });
      const Stress expected = components(hooke(gradient, steel(), kinematics));
      const auto nodal = recovered(stresses(block.mesh, steel(), kinematics, u, formulation));
      EXPECT_LT((nodal.rowwise() - expected.transpose()).cwiseAbs().maxCoeff(), 1e-10 * expected.norm()) << name;
      EXPECT_LT(squared_errors(block.mesh, steel(), kinematics, u, nodal, formulation).sum(), 1e-18 * expected.norm()) << name;
    }
}

// C_ijkl of a material along `axes` (rows), by the sum over its four indices.
Eigen::Matrix3d turned_law(const Orthotropy& m, const Eigen::Matrix3d& axes, const Eigen::Matrix3d& strain)
{
  const Eigen::Matrix3d normal = flexibility(m).inverse();
  const auto& [g12, g13, g23] = m.shear_modulus;
  const Eigen::Matrix3d shear = (Eigen::Matrix3d() << 0, g12, g13, g12, 0, g23, g13, g23, 0).finished();
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  const auto along = [&](int a) { return Eigen::Vector3d(axes.row(a).transpose()); };
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const double own = along(a).dot(strain * along(b));
      if (a != b) stress += 2 * shear(a, b) * own * along(a) * along(b).transpose();
      for (int c = 0; a == b && c < 3; ++c) stress += normal(c, a) * own * along(c) * along(c).transpose();
    }
  return stress;
}

TEST(Stress, OrthotropicStressIsThatOfTheTurnedLaw)
{
  const Orthotropy wood{{900, 300, 500}, {0.3, 0.2, 0.25}, {120, 150, 90}, {}, {}};
  for (const auto& [name, kinematics] : all_cases()) {
    if (kinematics == Kinematics::axisymmetric) continue;  // no constant stress
    const bool planar = dimension(kinematics) == 2;
    const std::array<double, 3> x{1, 0.8, planar ? 0.0 : 0.3}, y{-0.2, 1, 0.4};
    Material m;
    m.orthotropic = wood;
    m.directions = std::make_shared<deck::LocalAxes>(deck::AxesOptions{{}, {}, x, y}, planar);
    for (const auto formulation : {Formulation::standard, Formulation::incompatible}) {
      Block block(name, {3, 3, 3}, {1, 2, 1.5});
      if (!applies(formulation, block.mesh.cells.type[0])) continue;
      block.distort(0.07, true);
      const auto gradient = some_gradient(block.dimension);
      const auto u = sample(block.mesh, block.dimension, [&](const Point& at) { return Point(gradient * at); });
      const Eigen::Matrix3d axes = *m.directions->at(Point::Zero());
      Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
      if (kinematics == Kinematics::plane_stress) {  // linear in the strain across
        const double none = turned_law(wood, axes, strain)(2, 2);
        strain(2, 2) = 1;
        const double one = turned_law(wood, axes, strain)(2, 2);
        strain(2, 2) = -none / (one - none);
      }
      const Stress expected = components(turned_law(wood, axes, strain));
      const auto field = stresses(block.mesh, m, kinematics, u, formulation);
      EXPECT_LT((recovered(field).rowwise() - expected.transpose()).cwiseAbs().maxCoeff(), 1e-10 * expected.norm()) << name;
      const auto k = stiffness(block.mesh, m, kinematics, formulation);
      const double energy = 0.5 * u.dot(k.selfadjointView<Eigen::Lower>() * u);
      EXPECT_NEAR(field.strain_energy, energy, 1e-11 * energy) << name;
      const auto motions = rigid_motions(block.mesh.points, kinematics);
      EXPECT_LT((k.selfadjointView<Eigen::Lower>() * motions).cwiseAbs().maxCoeff(), 1e-10 * k.coeffs().maxCoeff()) << name;
    }
  }
}

// Pure bending, u = (x y, -x^2 / 2): one layer with incompatible modes has the stress E y.
TEST(Stress, IncompatibleModesHaveTheStressOfBending)
{
  const Block block("quad4", {4, 1, 0}, {4, 1, 0});
  const Material m{1000, 0, 0, 0};
  const auto u = sample(block.mesh, 2, [](const Point& x) { return Point(x[0] * (x[1] - 0.5), -x[0] * x[0] / 2, 0); });
  const auto field = stresses(block.mesh, m, Kinematics::plane_stress, u, Formulation::incompatible);
  const auto nodal = recovered(field);
  for (std::size_t n = 0; n < block.mesh.node_count(); ++n)
    EXPECT_LT((nodal.row(static_cast<Eigen::Index>(n)).transpose() -
               (Stress() << 1000 * (block.mesh.points[n][1] - 0.5), 0, 0, 0, 0, 0).finished())
                  .norm(),
              1e-9);
}

// u = (x y, 0) at the corners of a cell a x b, y from its middle: standard cells have the strain y along x, with all that goes
// across, and the shear x; modes leave E y alone.
TEST(Stress, ErrorOfBendingIsWhatModesTakeAway)
{
  const double young = 1000, nu = 0.3, a = 2, b = 0.5;
  const Block block("quad4", {1, 1, 0}, {a, b, 0});
  const Material m{young, nu, 0, 0};
  const auto u = sample(block.mesh, 2, [&](const Point& x) { return Point((x[0] - a / 2) * (x[1] - b / 2), 0, 0); });
  const double across = young * nu * nu / (1 - nu * nu) * b * b / 12, shear = young / (2 * (1 + nu)) * a * a / 12;
  EXPECT_NEAR(squared_errors_of_bending(block.mesh, m, Kinematics::plane_stress, u).sum(), (across + shear) * a * b,
              1e-9 * young);
  const auto stretched = sample(block.mesh, 2, [](const Point& x) { return Point(x[0], x[1], 0); });
  EXPECT_LT(squared_errors_of_bending(block.mesh, m, Kinematics::plane_stress, stretched).sum(), 1e-9 * young);
}

// Cells of second order hide what they lack where the bulk modulus is far above that of shear, but for triangles.
TEST(Stress, LockingIsUnseenBySecondOrderAlone)
{
  const auto times = [](const char* element, double nu, Kinematics kinematics, Formulation formulation = Formulation::standard) {
    const Block block(element, {1, 1, 0}, {1, 1, 0});
    return unseen_by_locking(block.mesh, Material{1000, nu, 0, 0}, kinematics, formulation).maxCoeff();
  };
  const double bulk_over_shear = 2 * 1.49 / (3 * 0.02);
  EXPECT_NEAR(times("quad9", 0.49, Kinematics::plane_strain), 1 + 0.5 * std::log10(bulk_over_shear / 10), 1e-9);
  EXPECT_NEAR(times("quad8", 0.49, Kinematics::axisymmetric), 1 + 0.5 * std::log10(bulk_over_shear / 10), 1e-9);
  EXPECT_EQ(times("quad9", 0.45, Kinematics::plane_strain), 1);
  EXPECT_EQ(times("quad9", 0.499999, Kinematics::plane_strain), 2.2);
  EXPECT_EQ(times("quad9", 0.49, Kinematics::plane_stress), 1);
  EXPECT_EQ(times("tri6", 0.49, Kinematics::plane_strain), 1);
  EXPECT_EQ(times("quad4", 0.49, Kinematics::plane_strain), 1);
  EXPECT_EQ(times("quad9", 0.49, Kinematics::plane_strain, Formulation::bbar), 1);
}

// Stretched by 1 with free sides: E in plane stress; E / (1 - nu^2) and nu times that across the plane in plane strain.
TEST(Stress, PlaneStatesUnderTension)
{
  const Material m{1000, 0.25, 0, 0};
  const Block block("quad4", {2, 2, 1});
  const auto pulled = [&](double across) {
    return sample(block.mesh, 2, [&](const Point& x) { return Point(x[0], across * x[1], 0); });
  };
  const auto stress = recovered(stresses(block.mesh, m, Kinematics::plane_stress, pulled(-0.25)));
  const auto strain = recovered(stresses(block.mesh, m, Kinematics::plane_strain, pulled(-0.25 / 0.75)));
  const double stiff = 1000 / (1 - 0.0625);
  EXPECT_LT((stress.row(0) - (Stress() << 1000, 0, 0, 0, 0, 0).finished().transpose()).norm(), 1e-10);
  EXPECT_LT((strain.row(0) - (Stress() << stiff, 0, 0.25 * stiff, 0, 0, 0).finished().transpose()).norm(), 1e-10);
}

// Linear stress that the multilinear cells can hold: extrapolation from their integration points finds it at every node, the
// surface included.
TEST(Stress, RecoveryIsExactForALinearStressOfMultilinearCells)
{
  for (const auto& [name, kinematics] : {Case{"hex8", Kinematics::solid}, Case{"quad4", Kinematics::plane_strain}}) {
    const Block block(name, {3, 2, 2}, {1, 2, 3});
    const auto displacement = [](const Point& x) { return Point(1e-3 * x[0] * x[1], 2e-3 * x[0] * x[1], 0); };
    const auto gradient = [](const Point& x) {
      Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
      h(0, 0) = 1e-3 * x[1], h(0, 1) = 1e-3 * x[0], h(1, 0) = 2e-3 * x[1], h(1, 1) = 2e-3 * x[0];
      return h;
    };
    const auto nodal = recovered(stresses(block.mesh, steel(), kinematics, sample(block.mesh, block.dimension, displacement)));
    for (std::size_t n = 0; n < block.mesh.node_count(); ++n) {
      const Stress expected = components(hooke(gradient(block.mesh.points[n]), steel(), kinematics));
      EXPECT_LT((nodal.row(static_cast<Eigen::Index>(n)).transpose() - expected).norm(), 1e-9) << name;
    }
  }
}

// Cells of different volumes meet in a node: the larger one counts more.
TEST(Stress, RecoveryWeighsByVolume)
{
  Block block("hex8", {2, 1, 1}, {2, 1, 1});
  for (auto& p : block.mesh.points)
    if (p[0] > 1.5) p[0] = 4;  // cells [0, 1] and [1, 4]
  const auto u = sample(block.mesh, 3,
                        [](const Point& x) { return Point(x[0] < 1.5 ? x[0] : 1 + 5 * (x[0] - 1), 0, 0); });  // strains 1 and 5
  const Material m{100, 0, 0, 0};
  const auto nodal = recovered(stresses(block.mesh, m, Kinematics::solid, u));
  for (std::size_t n = 0; n < block.mesh.node_count(); ++n) {
    const double x = block.mesh.points[n][0];
    EXPECT_NEAR(nodal(static_cast<Eigen::Index>(n), 0), x < 0.5 ? 100 : x < 1.5 ? (1 * 100 + 3 * 500) / 4.0 : 500, 1e-9);
  }
}

// The interpolant of u = x^2 is wrong by a strain of 2 (x - centre) in each cell. Away from the ends recovery finds the true
// stress, so the estimate is the true error there.
TEST(Stress, ErrorEstimateIsTheErrorWhereRecoveryIsExact)
{
  for (const auto& [name, kinematics] :
       {Case{"hex8", Kinematics::solid}, Case{"quad4", Kinematics::plane_strain}, Case{"quad4", Kinematics::plane_stress}}) {
    const Block block(name, {6, 2, 2}, {3, 1, 1});
    const auto u = sample(block.mesh, block.dimension, [](const Point& x) { return Point(x[0] * x[0], 0, 0); });
    const auto errors =
        squared_errors(block.mesh, steel(), kinematics, u, recovered(stresses(block.mesh, steel(), kinematics, u)));
    const auto [lambda, mu] = lame(steel(), kinematics);
    const double h = 0.5, section = block.dimension == 3 ? 0.25 : 0.5;
    const double expected = (lambda + 2 * mu) * 4 * h * h * h / 12 * section;
    int checked = 0;
    for (std::size_t c = 0; c < block.mesh.cells.size(); ++c) {
      double centre = 0;
      for (const Local n : block.mesh.cells[c])
        centre += block.mesh.points[static_cast<std::size_t>(n)][0] / static_cast<double>(block.mesh.cells[c].size());
      if (centre < 0.5 || centre > 2.5) continue;
      EXPECT_NEAR(errors[static_cast<Eigen::Index>(c)], expected, 1e-10 * expected) << name;
      ++checked;
    }
    EXPECT_EQ(checked, block.dimension == 3 ? 16 : 8);
  }
}

}  // namespace
}  // namespace mortise::fem
