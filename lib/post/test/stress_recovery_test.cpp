// Stresses recovered from displacements that are given: uniform ones, and such whose error is known. The same on any ranks.
#include "post/stress_recovery.hpp"

#include <gtest/gtest.h>

#include "post/interior.hpp"
#include "testing/cut.hpp"

namespace mortise::post {
namespace {

constexpr double young = 200, length = 2, width = 1;
constexpr int cells = 8;

// A bar along x of cells 0.25 x 0.5 x 0.5 in four subdomains.
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
    mesh.blocks["bar"].cells = {cells, 2, 2};
    partition::Options options;
    options.method = "grid";
    options.counts["bar"] = {4, 1, 1};
    decomposition = partition::cut_of(mesh, options, comm);
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
      constitution.push_back({fem::Material{young, poisson, 0, 1e-3}, fem::Formulation::standard, warmer});
    directory = std::make_unique<partition::NodeDirectory>(partition::even_directory(decomposition, comm));
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
// E a^2 h^2 / 12 times the volume. Patches find the true stress everywhere. Averages at the nodes are exact within; at both ends
// they keep the cell's own stress and are off by a x h / 2 at most, falling to zero over the last cell: E (a h / 2)^2 / 3 there.
TEST(StressRecovery, TheErrorOfALinearStressIsFound)
{
  constexpr double a = 1e-2, h = length / cells;
  const Bar bar(0);
  const auto u = bar.displacement([](const Point& x) { return Point(0.5 * a * x[0] * x[0], 0, 0); });
  const auto field = recover_stress(bar.bodies(), u, bar.comm);
  const double exact = young * a * a * h * h / 12 * length * width * width;
  constexpr double ends = 2.0 / cells;
  EXPECT_NEAR(field.squared_error, (1 + ends) * exact, 1e-6 * exact);
  EXPECT_NEAR(bar.comm.sum(field.body_error[0]), (1 + ends) * exact, 1e-6 * exact);
  const auto norms = energy_norms(bar.bodies(), u, bar.comm);
  EXPECT_NEAR(norms.error, std::sqrt(exact), 1e-10 * std::sqrt(exact));
  EXPECT_GT(norms.solution, norms.error);
  EXPECT_NEAR(norms.solution, std::sqrt(2 * field.strain_energy), 1e-12 * norms.solution);
  const auto worst = largest_of_ranks(field.worst_cell, bar.comm);
  EXPECT_NEAR(worst[0].value, 2 * exact / (4 * cells), 1e-6 * exact);  // a cell at an end
}

// u = a x^2 / 2 along x: the largest and the smallest values lie at the ends, exact ones at the nodes with the lowest numbers
// there; of a part of the nodes, at the end of that.
TEST(Extremes, AreFoundWithTheirPlaces)
{
  constexpr double a = 1e-2, h = length / cells;
  const Bar bar(0);
  const auto u = bar.displacement([](const Point& x) { return Point(-0.5 * a * x[0] * x[0], 0, 0); });
  const auto field = recover_stress(bar.bodies(), u, bar.comm);
  Probes probes;
  using enum fem::Quantity;
  const std::vector<std::pair<fem::Quantity, bool>> asked{
      {sxx, false}, {sxx, true}, {displacement, false}, {ux, false}, {principal_stress, true}, {principal_stress, false}};
  for (const auto& [quantity, smallest] : asked) probes.extremes.push_back({quantity, smallest, {true}, {}, {}});
  auto& part = probes.extremes.emplace_back(ExtremeProbe{sxx, true, {true}, {}, {}});
  for (const auto& s : bar.decomposition.subdomains) {
    auto& nodes = part.nodes.emplace_back();
    for (const auto& p : s.mesh.points) nodes.push_back(p[0] < 0.6 && p[1] > 0.9);
  }
  probes.extremes.push_back({sxx, true, {false}, {}, {}});
  const auto found = find_extremes(bar.decomposition, probes, u, field, {}, {}, {}, bar.comm);
  ASSERT_EQ(found.size(), 8U);
  const auto expect = [&](std::size_t i, double value, double x) {
    EXPECT_NEAR(found[i].value, value, 1e-12 * young) << i;
    EXPECT_NEAR(found[i].at[0], x, 1e-12) << i;
    EXPECT_EQ(found[i].body, 0);
  };
  // At the ends stresses are those of the cells there.
  expect(0, -young * a * h / 2, 0);
  EXPECT_NEAR(found[1].value, -young * a * (length - h / 2), 1e-12 * young);
  expect(2, 0.5 * a * length * length, length);
  expect(3, 0, 0);
  for (const std::size_t i : {2, 3}) EXPECT_EQ(found[i].at[1], 0) << i;
  EXPECT_NEAR(found[4].value, found[1].value, 1e-12 * young);
  EXPECT_NEAR(found[5].value, 0, 1e-12 * young);
  EXPECT_NEAR(found[6].value, -young * a * 0.5, 1e-12 * young);
  EXPECT_NEAR(found[6].at[0], 0.5, 1e-12);
  EXPECT_NEAR(found[6].at[1], 1, 1e-12);
  EXPECT_TRUE(std::isnan(found[7].value));
  EXPECT_EQ(found[7].body, -1);
}

}  // namespace
}  // namespace mortise::post
