// Bodies that expand by a change of temperature.
#include <gtest/gtest.h>

#include "fem/loads.hpp"
#include "fem/stress.hpp"
#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

constexpr double strain = 1.3e-3;  // what a body expands by if nothing holds it

// Expands by a strain of 1 a degree.
Material warm_steel()
{
  Material material = steel();
  material.thermal_expansion = 1;
  return material;
}

struct Expanding {
  Case what;
  Formulation formulation;
  Block block;
};

// Every cell in every kinematics, with each of its formulations, distorted; in axisymmetry a ring.
std::vector<Expanding> all_bodies()
{
  auto cases = all_cases();
  for (const char* name : {"tri3", "quad4", "tri6", "quad8", "quad9"}) cases.push_back({name, Kinematics::axisymmetric});
  std::vector<Expanding> bodies;
  for (const auto& what : cases)
    for (const auto formulation : {Formulation::standard, Formulation::bbar, Formulation::incompatible}) {
      const bool ring = what.kinematics == Kinematics::axisymmetric;
      if (!applies(formulation, mesh::cell_type(what.element).value())) continue;
      if ((ring && formulation == Formulation::incompatible) ||
          (what.kinematics == Kinematics::plane_stress && formulation == Formulation::bbar))
        continue;
      bodies.push_back({what, formulation, Block(what.element, {3, 3, 2}, {1, 2, 1.5})});
      auto& mesh = bodies.back().block.distort(0.07).mesh;
      if (ring)
        for (auto& p : mesh.points) p[0] += 0.5;
    }
  return bodies;
}

// The displacement of the free body: across a plane strain cannot expand, so that the plane expands the more.
Eigen::VectorXd free_expansion(const Expanding& body)
{
  const double in_plane = body.what.kinematics == Kinematics::plane_strain ? (1 + steel().poisson_ratio) * strain : strain;
  return sample(body.block.mesh, body.block.dimension, [&](const Point& x) { return Point(in_plane * x); });
}

double volume(const Expanding& body)
{
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(body.block.mesh.node_count()) * body.block.dimension);
  add_acceleration(body.block.mesh, body.what.kinematics, 1, Point(0, 1, 0), weight);
  return weight.sum();
}

TEST(Expansion, OfAFreeBodyIsInEquilibriumAndHasNoStress)
{
  for (const auto& body : all_bodies()) {
    const auto& [name, kinematics] = body.what;
    const auto& mesh = body.block.mesh;
    const auto u = free_expansion(body);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
    add_expansion(mesh, warm_steel(), kinematics, strain, f);
    EXPECT_GT(f.norm(), 1);
    EXPECT_LT((dense(stiffness(mesh, warm_steel(), kinematics, body.formulation)) * u - f).norm(), 1e-11 * f.norm()) << name;

    const auto field = stresses(mesh, warm_steel(), kinematics, u, body.formulation, strain);
    const Eigen::MatrixXd nodal = field.nodal_sums.leftCols(6).array().colwise() / field.nodal_sums.col(6).array();
    const double size = steel().young_modulus * strain, across = kinematics == Kinematics::plane_strain ? -size : 0;
    const Eigen::RowVectorXd expected = (Eigen::RowVectorXd(6) << 0, 0, across, 0, 0, 0).finished();
    EXPECT_LT((nodal.rowwise() - expected).cwiseAbs().maxCoeff(), 1e-10 * size) << name;
    EXPECT_LT((field.cell_von_mises.array() - std::abs(across)).abs().maxCoeff(), 1e-10 * size) << name;
    EXPECT_NEAR(field.strain_energy, 0.5 * across * across / steel().young_modulus * volume(body), 1e-10 * size * strain) << name;
    EXPECT_LT(squared_errors(mesh, warm_steel(), kinematics, u, nodal, body.formulation, strain).sum(), 1e-18 * size) << name;
  }
}

// Held all over: the stress is that of the strain taken back, and the load is what the supports push with.
TEST(Expansion, OfAHeldBodyIsTakenBackByStress)
{
  for (const auto& body : all_bodies()) {
    const auto& [name, kinematics] = body.what;
    const auto& mesh = body.block.mesh;
    const Eigen::VectorXd u = Eigen::VectorXd::Zero(free_expansion(body).size());
    const auto field = stresses(mesh, warm_steel(), kinematics, u, body.formulation, strain);
    const double e = steel().young_modulus, nu = steel().poisson_ratio;
    const bool thin = kinematics == Kinematics::plane_stress;
    const double all_round = -e * strain / (thin ? 1 - nu : 1 - 2 * nu);
    const Eigen::RowVectorXd expected = (Eigen::RowVectorXd(6) << all_round, all_round, thin ? 0 : all_round, 0, 0, 0).finished();
    const Eigen::MatrixXd nodal = field.nodal_sums.leftCols(6).array().colwise() / field.nodal_sums.col(6).array();
    EXPECT_LT((nodal.rowwise() - expected).cwiseAbs().maxCoeff(), 1e-11 * e * strain) << name;
    // Work of the supports' stress on a linear displacement.
    Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
    add_expansion(mesh, warm_steel(), kinematics, strain, f);
    const auto along = sample(mesh, body.block.dimension, [](const Point& x) { return Point(0, x[1], 0); });
    EXPECT_NEAR(f.dot(along), -all_round * volume(body), 1e-11 * std::abs(all_round) * volume(body)) << name;
  }
}

// A temperature by a field that happens to be constant is that number; one that varies has the load and the stresses of its mean
// in each cell of first order, and makes a cell of second order bend without stress.
TEST(Expansion, OfATemperatureThatVaries)
{
  for (const auto& body : all_bodies()) {
    const auto& [name, kinematics] = body.what;
    const auto& mesh = body.block.mesh;
    Temperature even(0.25 * strain), linear;
    even.varying = [](const Point&) { return 0.75 * strain; };
    linear.varying = [](const Point& x) { return strain * (1 + 0.1 * x[0] - 0.2 * x[1]); };
    Eigen::VectorXd f = Eigen::VectorXd::Zero(free_expansion(body).size()), same = f, varied = f;
    add_expansion(mesh, warm_steel(), kinematics, strain, f);
    add_expansion(mesh, warm_steel(), kinematics, even, same, body.formulation);
    EXPECT_LT((f - same).norm(), 1e-13 * f.norm()) << name;
    // No stress, where no direction is held. Straight cells of second order, and bricks and rectangles with incompatible modes,
    // have the displacement (Boley and Weiner, Theory of Thermal Stresses, chapter 9) exactly.
    if (kinematics == Kinematics::axisymmetric || kinematics == Kinematics::plane_strain ||
        (mesh::first_order(mesh.cells.type[0]) == mesh.cells.type[0] && body.formulation != Formulation::incompatible))
      continue;
    const Block straight(name, {3, 3, 2}, {1, 2, 1.5});
    add_expansion(straight.mesh, warm_steel(), kinematics, linear, varied, body.formulation);
    const auto u = sample(straight.mesh, straight.dimension, [](const Point& x) {
      const double b = 0.1 * strain, c = -0.2 * strain;
      return Point(strain * x[0] + b * (x[0] * x[0] - x[1] * x[1] - x[2] * x[2]) / 2 + c * x[0] * x[1],
                   strain * x[1] + b * x[0] * x[1] + c * (x[1] * x[1] - x[0] * x[0] - x[2] * x[2]) / 2,
                   x[2] * (strain + b * x[0] + c * x[1]));
    });
    EXPECT_LT((dense(stiffness(straight.mesh, warm_steel(), kinematics, body.formulation)) * u - varied).norm(),
              1e-10 * varied.norm())
        << name;
    const auto field = stresses(straight.mesh, warm_steel(), kinematics, u, body.formulation, linear);
    EXPECT_LT(field.cell_von_mises.cwiseAbs().maxCoeff(), 1e-9 * steel().young_modulus * strain) << name;
  }
}

// T = y - 1/2 across each of so many layers: 2 E (alpha (y - y_mean))^2 / (1 - nu) a point in plane stress.
TEST(Expansion, ThatCellsDoNotTakeIsAnError)
{
  Temperature across;
  across.varying = [](const Point& x) { return strain * (x[1] - 0.5); };
  for (const int layers : {1, 2}) {
    const Block block("quad4", {3, layers, 1}, {3, 1, 1});
    const auto lacks = [&](Formulation formulation) {
      return squared_errors_of_temperature(block.mesh, warm_steel(), Kinematics::plane_stress, formulation, across).sum();
    };
    const double expected =
        3.0 / (12 * layers * layers) * 2 * steel().young_modulus * strain * strain / (1 - steel().poisson_ratio);
    EXPECT_NEAR(lacks(Formulation::standard), expected, 1e-9 * expected);
    EXPECT_EQ(lacks(Formulation::incompatible), 0);
  }
  const Block second("quad8", {3, 1, 1}, {3, 1, 1});
  EXPECT_EQ(
      squared_errors_of_temperature(second.mesh, warm_steel(), Kinematics::plane_stress, Formulation::standard, across).sum(), 0);
}

TEST(StrainEnergy, IsThatOfTheStiffness)
{
  for (const auto& body : all_bodies()) {
    const auto& [name, kinematics] = body.what;
    const auto& mesh = body.block.mesh;
    const auto u = sample(mesh, body.block.dimension, [](const Point& x) {
      return Point(1e-3 * (x[0] * x[1] + x[1] * x[1]), 2e-3 * x[0] * x[0] - 1e-3 * x[1], 1e-3 * x[2] * x[0]);
    });
    const double expected = 0.5 * u.dot(dense(stiffness(mesh, steel(), kinematics, body.formulation)) * u);
    EXPECT_NEAR(stresses(mesh, steel(), kinematics, u, body.formulation).strain_energy, expected, 1e-11 * expected) << name;
  }
}

}  // namespace
}  // namespace mortise::fem
