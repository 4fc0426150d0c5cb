#include "bem/steklov_poincare.hpp"

#include <gtest/gtest.h>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "bem/boundary_operators.hpp"
#include "bem/particular_solution.hpp"
#include "bem/surface_stress.hpp"
#include "surfaces.hpp"

namespace mortise::bem {
namespace {

fem::Material elastic(double nu)
{
  return {2.0, nu, 1.5, 1e-2};
}

Eigen::Matrix3d stress_of_gradient(const Eigen::Matrix3d& gradient, double nu)
{
  const double mu = 1 / (1 + nu), lambda = 2 * mu * nu / (1 - 2 * nu);
  return mu * (gradient + gradient.transpose()) + lambda * gradient.trace() * Eigen::Matrix3d::Identity();
}

std::vector<Panels> closed_surfaces()
{
  return {test::box({3, 3, 3}, Point(1, 1, 1)), test::tetrahedron(), test::sphere(1, 1), test::box({8, 8, 1}, Point(1, 1, 0.05))};
}

TEST(SteklovPoincare, ConstantStressIsExact)
{
  Eigen::Matrix3d gradient;
  gradient << 0.3, 0.2, -0.5, 0.7, -0.4, 0.1, 0.25, 0.9, 0.6;
  for (const double nu : {0.0, 0.3, 0.49})
    for (const auto& panels : closed_surfaces()) {
      const auto u = linear_field(panels, Point(3, -2, 1), gradient, Point(0.3, 0.4, 0.1));
      const Eigen::Matrix3d stress = stress_of_gradient(gradient, nu);
      Eigen::VectorXd t(3 * panels.size());
      for (Eigen::Index p = 0; p < panels.size(); ++p) t.segment<3>(3 * p) = stress * panels.normal[static_cast<std::size_t>(p)];
      const auto forces = nodal_forces(panels, t);
      const Eigen::VectorXd found = steklov_poincare(panels, elastic(nu)) * u;
      EXPECT_LT((found - forces).norm(), 1e-11 * forces.norm()) << nu << ' ' << panels.size();
      const Eigen::VectorXd traction = tractions(panels, elastic(nu), u);
      EXPECT_LT((traction - t).norm(), 1e-11 * t.norm()) << nu << ' ' << panels.size();
      const auto stresses = panel_stresses(panels, elastic(nu), u, traction);
      for (Eigen::Index p = 0; p < panels.size(); ++p) {
        const auto s = stresses.row(p);
        Eigen::Matrix3d tensor;
        tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
        EXPECT_LT((tensor - stress).norm(), 1e-10 * stress.norm());
      }
    }
}

TEST(SteklovPoincare, SemidefiniteWithSixZeroEigenvalues)
{
  for (const double nu : {0.0, 0.3, 0.49})
    for (const auto& panels : closed_surfaces()) {
      const auto s = steklov_poincare(panels, elastic(nu));
      EXPECT_EQ((s - s.transpose()).norm(), 0);
      const auto values = dense::symmetric_eigenvalues(s);
      const double largest = values[values.size() - 1];
      for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(values[i]), 1e-13 * largest) << panels.size();
      EXPECT_GT(values[6], 1e-6 * largest) << panels.size();
    }
}

// Soft motions keep their stiffness up to nu = 1/2, where V n vanishes on every closed surface: of a body, of its cavity.
TEST(SteklovPoincare, NearlyIncompressible)
{
  auto hollow = test::box({4, 4, 4}, Point(1, 1, 1));
  const auto cavity = test::box({2, 2, 2}, Point(0.4, 0.4, 0.4));
  const auto first = static_cast<Local>(hollow.points.size());
  for (const auto& p : cavity.points) hollow.points.push_back(p + Point(0.3, 0.3, 0.3));
  for (const auto& c : cavity.corners) hollow.corners.push_back({first + c[0], first + c[2], first + c[1]});
  hollow = make_panels(hollow.points, hollow.corners);
  for (const auto& panels : {test::box({3, 3, 3}, Point(1, 1, 1)), test::sphere(1, 1), hollow}) {
    const auto softest = [&](double nu) -> Eigen::VectorXd {
      const auto values = dense::symmetric_eigenvalues(steklov_poincare(panels, elastic(nu)));
      EXPECT_LT(values.head(6).cwiseAbs().maxCoeff(), 1e-12 * values[values.size() - 1]);
      return values.segment(6, 20);
    };
    const auto reference = softest(0.499);
    for (const double nu : {0.4999, 0.499999}) {
      const auto found = softest(nu);
      for (Eigen::Index i = 0; i < 20; ++i)
        EXPECT_NEAR(found[i] / reference[i], 1, 0.005) << nu << ' ' << i << ' ' << panels.size();
    }
  }
}

// A beam of length 1 bent by u = (x z, -nu y z, -(x^2 + nu (z^2 - y^2)) / 2) R about its middle axis: stress E R z along it.
TEST(SteklovPoincare, BendingConverges)
{
  const double nu = 0.3;
  std::vector<double> energy, traction;
  for (const int cells : {4, 8}) {
    const auto panels = test::box({cells, cells, cells}, Point(1, 1, 1));
    Eigen::VectorXd u(3 * panels.node_count()), t = Eigen::VectorXd::Zero(3 * panels.size());
    for (Eigen::Index n = 0; n < panels.node_count(); ++n) {
      const Point x = panels.points[static_cast<std::size_t>(n)] - Point(0.5, 0.5, 0.5);
      u.segment<3>(3 * n) = Point(x[0] * x[2], -nu * x[1] * x[2], -(x[0] * x[0] + nu * (x[2] * x[2] - x[1] * x[1])) / 2);
    }
    double norm = 0;
    for (std::size_t p = 0; p < panels.corners.size(); ++p) {
      const double z = (panels.corner(p, 0) + panels.corner(p, 1) + panels.corner(p, 2))[2] / 3 - 0.5;
      t[3 * static_cast<Eigen::Index>(p)] = 2.0 * z * panels.normal[p][0];
      norm += panels.area[p] * t.segment<3>(3 * static_cast<Eigen::Index>(p)).squaredNorm();
    }
    energy.push_back(std::abs(u.dot(steklov_poincare(panels, elastic(nu)) * u) / (2.0 / 12) - 1));
    const Eigen::VectorXd difference = tractions(panels, elastic(nu), u) - t;
    double sum = 0;
    for (std::size_t p = 0; p < panels.corners.size(); ++p)
      sum += panels.area[p] * difference.segment<3>(3 * static_cast<Eigen::Index>(p)).squaredNorm();
    traction.push_back(std::sqrt(sum / norm));
  }
  EXPECT_LT(energy[1], 0.03);
  EXPECT_LT(energy[1], 0.35 * energy[0]);
  EXPECT_LT(traction[1], 0.2);
  EXPECT_LT(traction[1], 0.65 * traction[0]);
}

TEST(SteklovPoincare, RejectsSurfacesThatAreNone)
{
  const auto cube = test::box({2, 2, 2}, Point(1, 1, 1));
  auto open = cube.corners;
  open.pop_back();
  EXPECT_THROW(make_panels(cube.points, open), Error);
  auto turned = cube.corners;
  std::swap(turned[3][1], turned[3][2]);
  EXPECT_THROW(make_panels(cube.points, turned), Error);
  auto inward = cube.corners;
  for (auto& c : inward) std::swap(c[1], c[2]);
  EXPECT_THROW(make_panels(cube.points, inward), Error);
  auto flat = cube;
  flat.points[0] = flat.points[1];
  EXPECT_THROW(make_panels(flat.points, flat.corners), Error);
}

std::string refusal(const Panels& panels)
{
  try {
    steklov_poincare(panels, elastic(0.3));
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    return error.what();
  }
  return "";
}

// A bar that is bent until its end stands in its side, or that comes to lie on it, has no border that V and K could tell from a
// good one.
TEST(SteklovPoincare, RejectsSurfacesThatCrossThemselves)
{
  const auto bar = test::box({12, 2, 2}, Point(12, 1, 1));
  const auto bent = [&](double radius) {  // round an axis along y
    auto points = bar.points;
    for (auto& x : points) {
      const double angle = x[0] / radius, r = radius + x[2];
      x = Point(r * std::sin(angle), x[1], r * std::cos(angle));
    }
    return make_panels(std::move(points), bar.corners);
  };
  EXPECT_EQ(refusal(bent(2.5)), "");
  EXPECT_NE(refusal(bent(1.7)).find("crosses itself or lies on itself near ("), std::string::npos) << refusal(bent(1.7));

  // Two boxes, one set into the other: as one surface of theirs without a common node.
  auto both = test::box({3, 3, 3}, Point(1, 1, 1));
  const auto first = static_cast<Local>(both.points.size());
  const auto set_in = [&](const Point& by) {
    auto points = both.points;
    auto corners = both.corners;
    for (const auto& x : both.points) points.push_back(x + by);
    for (const auto& c : both.corners) corners.push_back({first + c[0], first + c[1], first + c[2]});
    return make_panels(std::move(points), std::move(corners));
  };
  EXPECT_EQ(refusal(set_in(Point(1.01, 0, 0))), "");
  for (const double by : {0.99, 0.5, 1.0}) EXPECT_NE(refusal(set_in(Point(by, 0.05, 0.05))), "") << by;
}

// A block that stands on a plane and is warmed: f = S (u - u_p) + integral of t_p phi has u's forces alone.
TEST(SteklovPoincare, LoadsOfWeightAndWarmth)
{
  const double nu = 0.3;
  fem::Constitution constitution{elastic(nu)};
  constitution.temperature_change = 25;
  const auto panels = test::box({3, 3, 3}, Point(1, 1, 1));
  const ParticularSolution warm(constitution, Point(0, 0, 0));
  const auto s = steklov_poincare(panels, elastic(nu));
  const Eigen::VectorXd free = linear_field(panels, Point(1, 2, 3), 0.25 * Eigen::Matrix3d::Identity(), Point(0, 0, 0));
  const Eigen::VectorXd load = s * warm.displacement(panels) - warm.nodal_forces(panels);
  EXPECT_LT((s * free - load).norm(), 1e-11 * load.norm());
  constitution.temperature_change = 0;
  std::vector<double> error;
  for (const int cells : {3, 6}) {
    const auto block = test::box({cells, cells, cells}, Point(1, 1, 1));
    constitution.acceleration = Point(0, 0, -4);  // u = (-nu x z, -nu y z, (z^2 - 2 z + nu (x^2 + y^2)) / 2 ...) b / E
    const ParticularSolution heavy(constitution, Point(0, 0, 0));
    Eigen::VectorXd u(3 * block.node_count()), support = Eigen::VectorXd::Zero(3 * block.node_count());
    const double scale = 6.0 / 2.0;  // weight a volume over Young's modulus
    for (Eigen::Index n = 0; n < block.node_count(); ++n) {
      const Point x = block.points[static_cast<std::size_t>(n)];
      const double h = 1 - x[2];  // stress -b h along z
      u.segment<3>(3 * n) = scale * Point(nu * x[0] * h, nu * x[1] * h, h * h / 2 + nu * (x[0] * x[0] + x[1] * x[1]) / 2);
    }
    for (std::size_t p = 0; p < block.corners.size(); ++p)
      if (block.normal[p][2] < -0.5)
        for (const Local n : block.corners[p]) support[3 * n + 2] += 6.0 * block.area[p] / 3;
    const Eigen::VectorXd forces =
        steklov_poincare(block, elastic(nu)) * (u - heavy.displacement(block)) + heavy.nodal_forces(block);
    error.push_back((forces - support).norm() / support.norm());
  }
  EXPECT_LT(error[1], 0.1);
  EXPECT_LT(error[1], 0.6 * error[0]);
}

}  // namespace
}  // namespace mortise::bem
