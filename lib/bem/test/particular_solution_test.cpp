#include "bem/particular_solution.hpp"

#include <gtest/gtest.h>

#include "bem/representation.hpp"
#include "surfaces.hpp"

namespace mortise::bem {
namespace {

using namespace test;

fem::Constitution heavy(const Point& acceleration, double temperature_change = 0)
{
  auto material = steel();
  material.density = 3;
  material.thermal_expansion = 0.01;
  return {material, fem::Formulation::standard, temperature_change, acceleration};
}

TEST(ParticularSolution, BalancesTheBodyForce)
{
  const Point acceleration(0.4, -0.7, 1.1), centre(0.3, 0.2, 0.1), x(1.2, -0.4, 0.6);
  const ParticularSolution particular(heavy(acceleration), centre);
  const Eigen::Matrix3d gradient = [&] {
    Eigen::Matrix3d result;
    for (int k = 0; k < 3; ++k)
      result.col(k) = (particular.displacement(x + Point::Unit(k)) - particular.displacement(x - Point::Unit(k))) / 2;
    return result;
  }();
  EXPECT_LT((components(hooke(steel(), gradient)) - particular.stress(x)).norm(), 1e-13);
  Point divergence = Point::Zero();
  for (int k = 0; k < 3; ++k)
    divergence += traction(particular.stress(x + Point::Unit(k)) - particular.stress(x - Point::Unit(k)), Point::Unit(k)) / 2;
  EXPECT_LT((divergence + 3 * acceleration).norm(), 1e-13);
}

// The resultant of t_p on a closed surface and its moment about any point are those of div sigma(u_p).
TEST(ParticularSolution, NodalForcesHaveTheResultantOfTheTractions)
{
  const Point acceleration(0.4, -0.7, 1.1), size(2, 1, 1.5);
  const auto panels = box({3, 2, 4}, size, [](double s) { return s * s; });
  const ParticularSolution particular(heavy(acceleration), {0.3, 0.2, 0.1});
  const Eigen::VectorXd forces = particular.nodal_forces(panels), tractions = particular.traction(panels);
  Point resultant = Point::Zero(), moment = Point::Zero(), of_panels = Point::Zero();
  for (Local n = 0; n < panels.node_count(); ++n) {
    resultant += forces.segment<3>(3 * n);
    moment += panels.points[static_cast<std::size_t>(n)].cross(Point(forces.segment<3>(3 * n)));
  }
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    of_panels += panels.area[p] * tractions.segment<3>(3 * static_cast<Eigen::Index>(p));
  const Point weight = -3 * size.prod() * acceleration;
  EXPECT_LT((resultant - weight).norm(), 1e-12);
  EXPECT_LT((of_panels - weight).norm(), 1e-12);
  EXPECT_LT((moment - (size / 2).cross(weight)).norm(), 1e-12);
}

// A bar that hangs from its upper end: sigma_zz = rho g z [Timoshenko and Goodier, Theory of elasticity, section 96], warm as
// well.
TEST(ParticularSolution, HangingBar)
{
  const double gravity = 0.6, weight = 3 * gravity, nu = steel().poisson_ratio, young = steel().young_modulus,
               expansion = 0.01 * 20;
  const Point size(1, 1, 2);
  const auto exact = [&](const Point& x) -> Point {
    return weight / young * Point(-nu * x[0] * x[2], -nu * x[1] * x[2], (x[2] * x[2] + nu * (x[0] * x[0] + x[1] * x[1])) / 2) +
           expansion * x;
  };
  const std::vector<Point> points{{0.4, 0.5, 0.9}, {0.7, 0.35, 1.2}, {0.3, 0.999999, 1.9}, {0.5, 0.5, 2}};
  const ParticularSolution particular(heavy({0, 0, -gravity}, 20), {0.1, 0.2, 0.3});
  std::array<double, 2> stress_error{}, displacement_error{};
  for (const int n : {4, 8}) {
    const auto panels = box({n, n, 2 * n}, size);
    Eigen::VectorXd u(3 * panels.node_count()), t(3 * panels.size());
    for (Local k = 0; k < panels.node_count(); ++k) u.segment<3>(3 * k) = exact(panels.points[static_cast<std::size_t>(k)]);
    for (std::size_t p = 0; p < panels.corners.size(); ++p) {
      const double z = (panels.corner(p, 0) + panels.corner(p, 1) + panels.corner(p, 2))[2] / 3;
      t.segment<3>(3 * static_cast<Eigen::Index>(p)) = Point(0, 0, weight * z * panels.normal[p][2]);
    }
    const auto rest = inside(panels, points, u - particular.displacement(panels), t - particular.traction(panels));
    const std::size_t at = n == 8;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      fem::Stress pulled = fem::Stress::Zero();
      pulled[2] = weight * points[i][2];
      const double error = (rest.stress.row(row).transpose() + particular.stress(points[i]) - pulled).norm();
      if (i >= 2) {
        EXPECT_LT(error, 1e-7 * weight) << i;
      }
      stress_error[at] = std::max(stress_error[at], error);
      displacement_error[at] =
          std::max(displacement_error[at],
                   (rest.displacement.row(row).transpose() + particular.displacement(points[i]) - exact(points[i])).norm());
    }
  }
  EXPECT_LT(stress_error[1], stress_error[0] / 3);
  EXPECT_LT(displacement_error[1], displacement_error[0] / 3);
  EXPECT_LT(stress_error[1], 2e-3 * weight * size[2]);
}

// Its divergence, its resultant, Hooke's law, and its energy against formulas.
TEST(ParticularSolution, StressAndEnergy)
{
  const double nu = 0.3;
  fem::Constitution constitution{fem::Material{2.0, nu, 1.5, 1e-2}};
  constitution.acceleration = Point(0, 0, -4);
  constitution.temperature_change = 25;
  const auto panels = test::box({2, 2, 4}, Point(1, 1, 3));
  const Point centre(0.2, 0.7, 0.1);
  const ParticularSolution particular(constitution, centre);
  // Divergence of its stress, by differences, is exact for a linear one.
  const double h = 0.5, density = 1.5;
  Point divergence = Point::Zero();
  const std::array<std::array<int, 3>, 3> place{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
  for (int j = 0; j < 3; ++j) {
    const fem::Stress difference = (particular.stress(h * Point::Unit(j)) - particular.stress(Point::Zero())) / h;
    for (std::size_t i = 0; i < 3; ++i) divergence[static_cast<int>(i)] += difference[place[i][static_cast<std::size_t>(j)]];
  }
  EXPECT_LT((divergence + density * constitution.acceleration).norm(), 1e-12);
  // Forces on the surface balance the weight.
  Point sum = Point::Zero();
  const auto f = particular.nodal_forces(panels);
  for (Eigen::Index n = 0; n < panels.node_count(); ++n) sum += f.segment<3>(3 * n);
  EXPECT_LT((sum + density * 3.0 * constitution.acceleration).norm(), 1e-12);
  // Its stress belongs to its displacement, less the free expansion, by Hooke's law.
  const Point at(0.4, 0.9, 1.7);
  Eigen::Matrix3d gradient;
  for (int j = 0; j < 3; ++j)
    gradient.col(j) =
        (particular.displacement(at + 1e-3 * Point::Unit(j)) - particular.displacement(at - 1e-3 * Point::Unit(j))) / 2e-3;
  const Eigen::Matrix3d stress = hooke(fem::Material{2.0, nu, 1.5, 1e-2}, gradient - 0.25 * Eigen::Matrix3d::Identity());
  const auto own = particular.stress(at);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(own[place[i][j]], stress(static_cast<int>(i), static_cast<int>(j)), 1e-9);
  // Energy: b^2 (z - c)^2 / (2 (lambda + 2 mu)) over the box.
  const double mu = 1 / (1 + nu), constrained = 2 * mu * nu / (1 - 2 * nu) + 2 * mu;
  EXPECT_NEAR(particular.strain_energy(panels), 36 / (2 * constrained) * (std::pow(2.9, 3) + std::pow(0.1, 3)) / 3, 1e-10);
}

}  // namespace
}  // namespace mortise::bem
