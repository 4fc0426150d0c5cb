// Boundary elements of plane models.
#include <gtest/gtest.h>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "bem/boundary_operators.hpp"
#include "bem/particular_solution.hpp"
#include "bem/plane_state.hpp"
#include "bem/representation.hpp"
#include "bem/steklov_poincare.hpp"
#include "bem/stress_recovery.hpp"
#include "bem/surface_stress.hpp"
#include "lines.hpp"

namespace mortise::bem {
namespace {

using namespace test;

fem::Material plane_material(double nu, fem::Kinematics kinematics = fem::Kinematics::plane_strain)
{
  return in_plane({2.0, nu, 1.5, 1e-2}, kinematics);
}

Eigen::Matrix3d plane_gradient()
{
  return (Eigen::Matrix3d() << 0.3, 0.2, 0, 0.7, -0.4, 0, 0, 0, 0).finished();
}

// Square root of the integral of the squared difference over that of the squared tractions.
double relative_error(const PlanePanels& panels, const Eigen::VectorXd& t, const Eigen::VectorXd& exact)
{
  double difference = 0, norm = 0;
  for (Eigen::Index p = 0; p < panels.size(); ++p) {
    const double length = panels.area[static_cast<std::size_t>(p)];
    difference += length * (t - exact).segment<2>(2 * p).squaredNorm();
    norm += length * exact.segment<2>(2 * p).squaredNorm();
  }
  return std::sqrt(difference / norm);
}

TEST(PlanePanels, RejectsBordersThatAreNone)
{
  const auto square = rectangle(1, 1, 2, 2);
  auto open = square.corners;
  open.pop_back();
  EXPECT_THROW(make_panels(square.points, open), Error);
  auto turned = square.corners;
  std::swap(turned[3][0], turned[3][1]);
  EXPECT_THROW(make_panels(square.points, turned), Error);
  auto inward = square.corners;
  for (auto& c : inward) std::swap(c[0], c[1]);
  EXPECT_THROW(make_panels(square.points, inward), Error);
  auto flat = square;
  flat.points[0] = flat.points[1];
  EXPECT_THROW(make_panels(flat.points, flat.corners), Error);
}

// Hooke's law of three dimensions with a free and with a held thickness.
TEST(PlaneState, StrainAndStress)
{
  const fem::Material material{2.0, 0.3, 1, 1e-2};
  const Eigen::Matrix3d gradient = plane_gradient();
  Eigen::Matrix3d free = gradient;  // ZZ such that it has no stress
  free(2, 2) = -0.3 / 0.7 * (gradient(0, 0) + gradient(1, 1));
  const Eigen::Matrix3d in_stress = hooke(in_plane(material, fem::Kinematics::plane_stress), gradient),
                        exact = hooke(material, free);
  EXPECT_NEAR(exact(2, 2), 0, 1e-15);
  EXPECT_LT((in_stress - exact).topLeftCorner(2, 2).norm(), 1e-15);
  // Warm in plane strain, where the plane expands freely: only the stress across it, which holds.
  fem::Constitution warm{material};
  warm.temperature_change = 20;
  const double expansion = 20 * in_plane(material, fem::Kinematics::plane_strain).thermal_expansion;
  const Eigen::Matrix3d elastic = Eigen::Vector3d(expansion - 0.2, expansion - 0.2, -0.2).asDiagonal();
  const Eigen::Matrix3d stress = hooke(material, elastic);
  EXPECT_NEAR(stress(0, 0), 0, 1e-15);
  EXPECT_NEAR(stress_across_plane(warm, fem::Kinematics::plane_strain, 0), stress(2, 2), 1e-15);
  EXPECT_EQ(stress_across_plane(warm, fem::Kinematics::plane_stress, 3), 0);
}

// V t = (M / 2 + K) u and D u + (M / 2 + K)' t = M't of linear fields, of Laplace's double layer -1/2.
TEST(PlaneOperators, LinearFieldsAreExact)
{
  for (const double nu : {0.0, 0.3, 0.49})
    for (const auto& panels : borders()) {
      const auto material = plane_material(nu);
      const auto field = linear(plane_gradient());
      const Eigen::VectorXd u = nodal(panels, field), t = tractions_of(panels, material, field);
      const auto [v, k, d] = boundary_operators(panels, material);
      const Eigen::VectorXd forces = nodal_forces(panels, t);
      EXPECT_LT((v * t - k * u).norm(), 1e-11 * (v * t).norm()) << panels.size();
      EXPECT_LT((d * u + k.transpose() * t - forces).norm(), 1e-11 * forces.norm()) << panels.size();
      EXPECT_LT((v - v.transpose()).norm(), 1e-15 * v.norm());
      EXPECT_LT((d - d.transpose()).norm(), 1e-14 * d.norm());
      EXPECT_GT(dense::symmetric_eigenvalues(v)[0], 0) << panels.size();
    }
}

TEST(PlaneSteklovPoincare, ConstantStressIsExact)
{
  for (const auto kinematics : {fem::Kinematics::plane_strain, fem::Kinematics::plane_stress})
    for (const double nu : {0.0, 0.3, 0.49})
      for (const auto& panels : borders()) {
        const auto material = plane_material(nu, kinematics);
        const auto field = linear(plane_gradient());
        const Eigen::VectorXd u = nodal(panels, field), t = tractions_of(panels, material, field),
                              forces = nodal_forces(panels, t);
        EXPECT_LT((tractions(panels, material, u) - t).norm(), 1e-11 * t.norm()) << panels.size();
        EXPECT_LT((steklov_poincare(panels, material) * u - forces).norm(), 1e-11 * forces.norm()) << panels.size();
      }
}

// Whatever the unit of length: S has none.
TEST(PlaneSteklovPoincare, ThreeRigidMotionsAndAUnitOfLength)
{
  for (const double nu : {0.0, 0.3, 0.49})
    for (const auto& panels : borders()) {
      const auto s = steklov_poincare(panels, plane_material(nu));
      EXPECT_EQ((s - s.transpose()).norm(), 0);
      for (const double unit : {1.0, 1e-6, 1e6}) {
        const auto other = unit == 1 ? s : steklov_poincare(scaled(panels, unit), plane_material(nu));
        EXPECT_LT((other - s).norm(), 1e-11 * s.norm()) << panels.size();
        const auto values = dense::symmetric_eigenvalues(other);
        const double largest = values[values.size() - 1];
        for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(values[i]), 1e-13 * largest) << panels.size();
        EXPECT_GT(values[3], 1e-8 * largest) << panels.size();
      }
    }
}

// A slit, both sides of which lie on each other: tractions on them cannot be told apart.
TEST(PlaneSteklovPoincare, RejectsASlit)
{
  auto panels = polygons({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}}}, 2);
  auto points = panels.points;
  std::vector<Point> loop;
  for (const auto& x : points) {
    if (x == Point(2, 1, 0)) loop.insert(loop.end(), {{2, 1, 0}, {1.5, 1, 0}, {1, 1, 0}, {1.5, 1, 0}});
    loop.push_back(x);
  }
  EXPECT_THROW(steklov_poincare(polygons({loop}, 1), plane_material(0.3)), Error);
}

// Energy E' h^3 l / 24 of a strip bent by curvature 1, E' = E / (1 - nu^2).
TEST(PlaneSteklovPoincare, BendingConverges)
{
  for (const double nu : {0.3, 0.49}) {
    const auto material = plane_material(nu);
    std::vector<double> energy, traction;
    for (const int cells : {4, 8, 16}) {
      auto panels = rectangle(2, 1, 2 * cells, cells);
      for (auto& x : panels.points) x[1] -= 0.5;
      const auto field = plane_bending(nu);
      const Eigen::VectorXd u = nodal(panels, field);
      energy.push_back(std::abs(u.dot(steklov_poincare(panels, material) * u) / (2.0 / (1 - nu * nu) * 2 / 12) - 1));
      traction.push_back(relative_error(panels, tractions(panels, material, u), tractions_of(panels, material, field)));
    }
    EXPECT_LT(energy[2], 0.01) << nu;
    EXPECT_LT(energy[2], 0.3 * energy[1]) << nu;
    EXPECT_LT(traction[2], 0.06) << nu;
    EXPECT_LT(traction[2], 0.6 * traction[1]) << nu;
  }
}

// A thick ring under pressure inside [Timoshenko and Goodier, Theory of elasticity, section 28]: u_r = a r + b / r. The forces
// of u at the nodes and the tractions, and the displacement under the exact forces.
TEST(PlaneSteklovPoincare, LameRingConverges)
{
  const double nu = 0.3, mu = 2.0 / 2.6, inner = 0.5, outer = 1, pressure = 0.2;
  const double share = pressure * inner * inner / (outer * outer - inner * inner);
  const double linear_part = share * (1 - 2 * nu) / (2 * mu), inverse_part = share * outer * outer / (2 * mu);
  std::vector<double> traction, displacement;
  for (const int sides : {16, 32, 64}) {
    const auto panels = ring(inner, outer, sides, 0.2);  // of even sides symmetry makes all exact
    const auto material = plane_material(nu);
    Eigen::VectorXd u(2 * panels.node_count()), t(2 * panels.size());
    for (Eigen::Index n = 0; n < panels.node_count(); ++n) {
      const Point& x = panels.points[static_cast<std::size_t>(n)];
      u.segment<2>(2 * n) = flattened<2>((linear_part + inverse_part / x.squaredNorm()) * x);
    }
    for (Eigen::Index p = 0; p < panels.size(); ++p) {
      const auto at = static_cast<std::size_t>(p);
      t.segment<2>(2 * p) = flattened<2>(panels.middle(at).norm() < 0.7 ? Point(-pressure * panels.normal[at]) : Point::Zero());
    }
    traction.push_back(relative_error(panels, tractions(panels, material, u), t));
    // S u = M't, u without rigid motions.
    const Eigen::VectorXd forces = nodal_forces(panels, t);
    const Eigen::VectorXd found = dense::minimum_norm(steklov_poincare(panels, material), forces);
    displacement.push_back(std::abs(forces.dot(found) / forces.dot(u) - 1));
  }
  EXPECT_LT(traction[2], 0.05);
  EXPECT_LT(traction[2], 0.6 * traction[1]);
  EXPECT_LT(displacement[2], 0.005);
  EXPECT_LT(displacement[2], 0.3 * displacement[1]);
}

// Linear stresses are exact on sides as at corners; ZZ is that of plane strain. At the nodes of polygons for circles the
// recovered ones, from linear slopes along straight panels, are near, the fit is exact.
TEST(PlaneStressRecovery, LinearStressesAreExact)
{
  const double nu = 0.3;
  const auto material = plane_material(nu);
  for (const auto& panels : borders()) {
    if (panels.size() < 12) continue;
    const auto field = plane_bending(nu);
    const Eigen::VectorXd u = nodal(panels, field), t = tractions_of(panels, material, field);
    const Eigen::VectorXd lengths = nodal_areas(panels);
    const auto recovered = Representation(panels, material).evaluate(panels.points, u, t).stress;
    const StressRecovery recovery(panels, material);
    double length = 0;
    for (Eigen::Index n = 0; n < panels.node_count(); ++n) {
      fem::Stress exact = fem::Stress::Zero();
      exact[0] = 2.0 / (1 - nu * nu) * panels.points[static_cast<std::size_t>(n)][1];
      exact[2] = nu * exact[0];
      const bool round = panels.size() == 24 || panels.size() == 32 || panels.size() == 52;
      EXPECT_LT((recovered.row(n).transpose() - exact).norm(), round ? 0.3 : 1e-7) << panels.size() << ' ' << n;
      const auto [constant, slope] = recovery.at(static_cast<Local>(n), {u, t});
      EXPECT_LT((constant - exact).norm(), 1e-10) << panels.size() << ' ' << n;
      EXPECT_NEAR(slope(0, 1), 2.0 / (1 - nu * nu), 1e-9);
      EXPECT_NEAR(slope(0, 0), 0, 1e-9);
      length += lengths[n];
    }
    double whole = 0;
    for (const double l : panels.area) whole += l;
    EXPECT_NEAR(length, whole, 1e-12 * whole);
  }
}

TEST(PlaneSurfaceStress, ConstantStressOnEveryPanel)
{
  const auto material = plane_material(0.3);
  const auto field = linear(plane_gradient());
  for (const auto& panels : borders()) {
    const Eigen::VectorXd u = nodal(panels, field), t = tractions_of(panels, material, field);
    const auto stresses = panel_stresses(panels, material, u, t);
    const fem::Stress exact = components(hooke(material, plane_gradient()));
    for (Eigen::Index p = 0; p < panels.size(); ++p) EXPECT_LT((stresses.row(p).transpose() - exact).norm(), 1e-12);
  }
}

// Nothing where the gradient is constant; of bending of a strip, of which u' is e = curvature (s - middle) off on each side along
// it, with E' / (4 pi) h the integral of e^2.
TEST(PlaneSurfaceStress, InterpolationErrors)
{
  const double nu = 0.3, young = 2.0 / (1 - nu * nu);
  const auto material = plane_material(nu);
  const auto field = linear(plane_gradient());
  for (const auto& panels : borders())
    EXPECT_LT(interpolation_errors(panels, material, nodal(panels, field), tractions_of(panels, material, field)).sum(), 1e-24);
  const double h = 0.125;
  auto strip = rectangle(20, 1, 160, 8);
  for (auto& x : strip.points) x[1] -= 0.5;
  const auto bent = plane_bending(nu);
  const auto errors = interpolation_errors(strip, material, nodal(strip, bent), tractions_of(strip, material, bent));
  for (std::size_t p = 0; p < strip.corners.size(); ++p) {
    if (std::abs(strip.middle(p)[0] - 10) > 5) continue;
    EXPECT_NEAR(errors[static_cast<Eigen::Index>(p)], young * h / (4 * std::numbers::pi) * h * h * h / 12, 1e-9);
  }
}

// A block that stands on the line y = 0 under its weight: stress -b h along y, h the height above it. And warm, free.
TEST(PlaneSteklovPoincare, LoadsOfWeightAndWarmth)
{
  for (const auto kinematics : {fem::Kinematics::plane_strain, fem::Kinematics::plane_stress}) {
    const double nu = 0.3;
    fem::Constitution constitution{fem::Material{2.0, nu, 1.5, 1e-2}};
    const auto material = in_plane(constitution.materials[0], kinematics);
    constitution.temperature_change = 25;
    const auto square = rectangle(1, 1, 5, 5);
    const ParticularSolution warm(constitution, Point(0.2, 0.3, 0), kinematics);
    const double expansion = 0.25 * (kinematics == fem::Kinematics::plane_strain ? 1 + nu : 1);
    const auto s = steklov_poincare(square, material);
    const Eigen::VectorXd free = linear_field(square, Point(1, 2, 0), expansion * Eigen::Matrix3d::Identity(), Point(0, 0, 0));
    const Eigen::VectorXd load = s * warm.displacement(square) - warm.nodal_forces(square);
    EXPECT_LT((s * free - load).norm(), 1e-11 * load.norm());
    // Held across the plane alone: E (alpha dT)^2 / 2.
    EXPECT_NEAR(warm.strain_energy(square), kinematics == fem::Kinematics::plane_strain ? 2.0 * 0.25 * 0.25 / 2 : 0, 1e-14);

    constitution.temperature_change = 0;
    constitution.acceleration = Point(0, -4, 7);  // what is across the plane does nothing
    const double weight = 6, young = material.young_modulus / (1 - std::pow(material.poisson_ratio, 2)),
                 across = material.poisson_ratio / (1 - material.poisson_ratio);
    std::vector<double> error;
    for (const int cells : {4, 8, 16}) {
      const auto block = rectangle(1, 1, cells, cells);
      const ParticularSolution heavy(constitution, Point(0, 0, 0), kinematics);
      Eigen::VectorXd u(2 * block.node_count()), support = Eigen::VectorXd::Zero(2 * block.node_count());
      for (Eigen::Index n = 0; n < block.node_count(); ++n) {
        const Point& x = block.points[static_cast<std::size_t>(n)];
        const double h = 1 - x[1];
        u.segment<2>(2 * n) = weight / young * Eigen::Vector2d(across * x[0] * h, (h * h + across * x[0] * x[0]) / 2);
      }
      for (std::size_t p = 0; p < block.corners.size(); ++p)
        if (block.normal[p][1] < -0.5)
          for (const Local n : block.corners[p]) support[2 * n + 1] += weight * block.area[p] / 2;
      const Eigen::VectorXd forces =
          steklov_poincare(block, material) * (u - heavy.displacement(block)) + heavy.nodal_forces(block);
      error.push_back((forces - support).norm() / support.norm());
      double sum = 0;
      for (Eigen::Index n = 0; n < block.node_count(); ++n) sum += forces[2 * n + 1];
      EXPECT_NEAR(sum, weight, 1e-11);
      // (lambda + 2 mu) e^2 / 2 over the square, e = b y / (lambda + 2 mu)
      const double constrained = young / (1 - across * across);
      EXPECT_NEAR(heavy.strain_energy(block), weight * weight / (2 * constrained) / 3, 1e-12);
    }
    EXPECT_LT(error[2], 0.05);
    EXPECT_LT(error[2], 0.6 * error[1]);
  }
}

}  // namespace
}  // namespace mortise::bem
