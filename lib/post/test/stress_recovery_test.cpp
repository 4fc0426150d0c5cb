// Stresses recovered from displacements that are given: uniform ones, and such whose error is known. The same on any ranks.
#include "post/stress_recovery.hpp"

#include <gtest/gtest.h>

#include "partition/decompose.hpp"

namespace mortise::post {
namespace {

constexpr double young = 200, length = 2, width = 1;
constexpr int cells = 8;

// A bar along x of cells 0.25 x 0.5 x 1 in four subdomains.
struct Bar {
  Communicator comm;
  partition::Decomposition decomposition;
  std::unique_ptr<partition::NodeDirectory> directory;
  partition::Interface interface;
  std::vector<fem::Constitution> constitution;

  explicit Bar(double poisson, double warmer = 0)
  {
    mesh::Options mesh;
    mesh.blocks["bar"].size = {length, width, width};
    mesh.blocks["bar"].cells = {cells, 2, 1};
    partition::Options options;
    options.method = "grid";
    options.counts["bar"] = {4, 1, 1};
    Timers timers;
    Log log(comm, nullptr);
    decomposition = partition::decompose(mesh, options, 3, {comm, log, timers});
    std::vector<std::vector<double>> weights;
    for (const auto& s : decomposition.subdomains) {
      weights.emplace_back(s.mesh.node_count(), 1.0);
      constitution.push_back({fem::Material{young, poisson, 0, 1e-3}, fem::Formulation::standard, warmer});
    }
    directory = std::make_unique<partition::NodeDirectory>(decomposition, weights, comm);
    interface = partition::find_interface(decomposition, *directory, comm);
  }

  template <class Field>
  std::vector<Eigen::VectorXd> displacement(const Field& u) const
  {
    std::vector<Eigen::VectorXd> result;
    for (const auto& s : decomposition.subdomains) {
      result.emplace_back(static_cast<Eigen::Index>(s.mesh.node_count()) * 3);
      for (std::size_t n = 0; n < s.mesh.node_count(); ++n)
        result.back().segment<3>(3 * static_cast<Eigen::Index>(n)) = Point(u(s.mesh.points[n]));
    }
    return result;
  }
  ElasticBodies bodies() const { return {decomposition, interface, fem::Kinematics::solid, constitution, 1}; }
};

// Uniaxial tension with Poisson's contraction is represented exactly.
TEST(StressRecovery, UniformTensionIsExact)
{
  constexpr double strain = 1e-3, poisson = 0.3;
  const Bar bar(poisson);
  const auto u = bar.displacement([&](const Point& x) { return Point(strain * Point(x[0], -poisson * x[1], -poisson * x[2])); });
  const auto field = recover_stress(bar.bodies(), u, bar.comm);
  const double stress = young * strain;
  for (std::size_t s = 0; s < field.nodal.size(); ++s) {
    Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(field.nodal[s].rows(), 6);
    exact.col(0).setConstant(stress);
    EXPECT_LT((field.nodal[s] - exact).cwiseAbs().maxCoeff(), 1e-12 * stress);
    EXPECT_LT((field.cell_von_mises[s].array() - stress).abs().maxCoeff(), 1e-12 * stress);
  }
  EXPECT_TRUE(field.by_material.empty());
  EXPECT_NEAR(field.largest_von_mises.value, stress, 1e-12 * stress);
  const double energy = 0.5 * stress * strain * length * width * width;
  EXPECT_NEAR(field.strain_energy, energy, 1e-12 * energy);
  EXPECT_LT(field.squared_error, 1e-20 * energy);
}

// What expands freely is not stressed.
TEST(StressRecovery, FreeExpansionHasNoStress)
{
  constexpr double warmer = 50, strain = 1e-3 * warmer;
  const Bar bar(0.3, warmer);
  const auto field = recover_stress(bar.bodies(), bar.displacement([&](const Point& x) { return Point(strain * x); }), bar.comm);
  EXPECT_LT(field.largest_von_mises.value, 1e-12 * young * strain);
  EXPECT_LT(field.strain_energy, 1e-20);
}

// u = a x^2 / 2 without Poisson's effect: the strain a x is a x_c in a cell, so that the squared error in the energy norm is
// E a^2 h^2 / 12 times the volume. Averages at the nodes are exact within; at both ends they keep the cell's own stress, which
// makes the same error.
TEST(StressRecovery, TheErrorOfALinearStressIsFound)
{
  constexpr double a = 1e-2, h = length / cells;
  const Bar bar(0);
  const auto u = bar.displacement([](const Point& x) { return Point(0.5 * a * x[0] * x[0], 0, 0); });
  const auto field = recover_stress(bar.bodies(), u, bar.comm);
  const double exact = young * a * a * h * h / 12 * length * width * width;
  EXPECT_NEAR(field.squared_error, exact, 1e-10 * exact);
  EXPECT_NEAR(bar.comm.sum(field.body_error[0]), exact, 1e-10 * exact);
  const auto norms = energy_norms(bar.bodies(), u, bar.comm);
  EXPECT_NEAR(norms.error, std::sqrt(exact), 1e-10 * std::sqrt(exact));
  EXPECT_NEAR(norms.solution, std::sqrt(2 * field.strain_energy), 1e-12 * norms.solution);
  const auto worst = largest_of_ranks(field.worst_cell, bar.comm);
  EXPECT_NEAR(worst[0].value, exact / (2 * cells), 1e-9 * exact);
}

}  // namespace
}  // namespace mortise::post
