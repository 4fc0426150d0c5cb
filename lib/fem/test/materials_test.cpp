// Pieces of several materials: the whole is the sum of its parts.
#include "fem/materials.hpp"

#include <gtest/gtest.h>

#include "fem/loads.hpp"
#include "fem/stress.hpp"
#include "mesh/topology.hpp"
#include "sample.hpp"

namespace mortise::fem {
namespace {

using namespace test;

Material material(double young_modulus, double poisson_ratio, double density)
{
  return {young_modulus, poisson_ratio, density, 0};
}

// The lower half of the cells is soft, the upper hard.
struct Layers {
  Block block;
  std::vector<Local> cells[2];
  std::vector<int> of_cell;
  Materials materials;

  explicit Layers(const std::string& element, bool distorted = true) : block(element, {2, 2, 4}), materials(material(1, 0.3, 2))
  {
    const int axis = block.dimension - 1;
    for (std::size_t c = 0; c < block.mesh.cells.size(); ++c) {
      double mean = 0;
      for (const Local n : block.mesh.cells[c]) mean += block.mesh.points[static_cast<std::size_t>(n)][axis];
      const int half = mean / static_cast<double>(block.mesh.cells[c].size()) > 0.5 ? 1 : 0;
      of_cell.push_back(half);
      cells[half].push_back(static_cast<Local>(c));
    }
    if (distorted) block.distort(0.05);
    materials = Materials({material(1, 0.3, 2), material(1e6, 0.1, 5)}, of_cell);
  }
};

Kinematics kinematics_of(const Layers& layers)
{
  return layers.block.dimension == 3 ? Kinematics::solid : Kinematics::plane_strain;
}

TEST(Materials, StiffnessAndWeightAreThoseOfTheParts)
{
  for (const char* element : {"hex8", "tet10", "quad4"}) {
    const Layers layers(element);
    const auto& mesh = layers.block.mesh;
    const auto kinematics = kinematics_of(layers);
    const int d = layers.block.dimension;
    const auto n = static_cast<Eigen::Index>(mesh.node_count()) * d;
    const Eigen::MatrixXd whole = stiffness(mesh, layers.materials, kinematics);
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(n), weights = weight;
    const Point g(1, -2, d == 3 ? 3 : 0);
    add_acceleration(mesh, kinematics, layers.materials, g, weight);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
    for (int half = 0; half < 2; ++half) {
      const auto part = mesh::Submeshes(mesh)(layers.cells[half]);
      const auto& own = layers.materials[static_cast<std::size_t>(half)];
      const Eigen::MatrixXd k = stiffness(part, own, kinematics);
      Eigen::VectorXd f = Eigen::VectorXd::Zero(k.rows());
      add_acceleration(part, kinematics, own, g, f);
      const auto place = [&](Eigen::Index i) {
        const auto id = part.node_id[static_cast<std::size_t>(i / d)];
        return (std::lower_bound(mesh.node_id.begin(), mesh.node_id.end(), id) - mesh.node_id.begin()) * d + i % d;
      };
      for (Eigen::Index i = 0; i < k.rows(); ++i) {
        weights[place(i)] += f[i];
        for (Eigen::Index j = 0; j <= i; ++j) sum(std::max(place(i), place(j)), std::min(place(i), place(j))) += k(i, j);
      }
    }
    EXPECT_LT((whole - sum).cwiseAbs().maxCoeff(), 1e-10 * sum.cwiseAbs().maxCoeff()) << element;
    EXPECT_LT((weight - weights).norm(), 1e-13 * weights.norm()) << element;
  }
}

// Stretched along the layers, each has its own constant stress, which recovery must keep apart: no error then.
TEST(Materials, StressesAreNotAveragedAcrossTheJump)
{
  for (const char* element : {"hex8", "tet4", "hex20", "quad4"}) {
    const Layers layers(element, false);
    const auto& mesh = layers.block.mesh;
    const auto kinematics = kinematics_of(layers);
    const Materials without({material(1, 0, 0), material(1e6, 0, 0)}, layers.of_cell);
    const auto u = sample(mesh, layers.block.dimension, [](const Point& x) { return Point(0.01 * x[0], 0, 0); });
    const auto field = stresses(mesh, without, kinematics, u, Formulation::standard, 0, 3);
    ASSERT_EQ(field.nodal_sums.cols(), 21);
    Eigen::MatrixXd recovered = Eigen::MatrixXd::Zero(field.nodal_sums.rows(), 18);
    int both = 0;
    for (Eigen::Index n = 0; n < recovered.rows(); ++n) {
      for (Eigen::Index k = 0; k < 2; ++k) {
        const double volume = field.nodal_sums(n, 7 * k + 6);
        if (volume == 0) continue;
        recovered.row(n).segment(6 * k, 6) = field.nodal_sums.row(n).segment(7 * k, 6) / volume;
        const double expected = k == 0 ? 0.01 : 1e4;
        EXPECT_NEAR(recovered(n, 6 * k), expected, 1e-9 * expected) << element;
      }
      both += field.nodal_sums(n, 6) > 0 && field.nodal_sums(n, 13) > 0 ? 1 : 0;
      EXPECT_EQ(field.nodal_sums(n, 20), 0);
    }
    EXPECT_GT(both, 2) << "nodes of the seam";
    EXPECT_LT(squared_errors(mesh, without, kinematics, u, recovered).sum(), 1e-12) << element;  // of 1e-4 1e6 / 2
  }
}

}  // namespace
}  // namespace mortise::fem
