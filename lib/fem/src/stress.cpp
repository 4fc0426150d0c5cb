#include "fem/stress.hpp"

#include <cmath>

#include "cell_temperature.hpp"
#include "elasticity.hpp"
#include "fem/stiffness.hpp"
#include "formulation.hpp"

namespace mortise::fem {

namespace {

using Stresses = Eigen::Matrix<double, 6, Eigen::Dynamic>;  // one a column

// Where point q of a cell is, for a law that wants to know.
Point place_for(const Elasticity& elasticity, const CellGeometry& cell, std::size_t q)
{
  return elasticity.uniform() ? Point::Zero() : place_of(cell, q);
}

// Calls visit(c, cell, stress, elasticity) for every cell c; stress is 6 x q.
template <class Visit>
void for_each_cell(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, Formulation formulation,
                   const Temperature& temperature_change, const Eigen::VectorXd& u, const Visit& visit)
{
  const int d = dimension(kinematics);
  std::vector<Elasticity> elasticity;
  std::vector<CellFormulation> cell_formulation;
  for (std::size_t m = 0; m < materials.count(); ++m) {
    elasticity.emplace_back(materials[m], kinematics);
    cell_formulation.emplace_back(formulation, elasticity.back(), kinematics);
  }
  CellGeometry cell(kinematics);
  Eigen::MatrixXd displacement;
  Stresses stress;
  std::vector<double> warmer;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    cell.gather(mesh, c);
    cell.evaluate();
    displacement.resize(d, cell.element().nodes);
    for (int i = 0; i < cell.element().nodes; ++i) displacement.col(i) = u.segment(nodes[static_cast<std::size_t>(i)] * d, d);
    stress.resize(6, static_cast<Eigen::Index>(cell.volumes().size()));
    const auto& own = elasticity[materials.index(c)];
    cell_temperature(temperature_change, cell, mesh, c, warmer);
    const auto& gradients = cell_formulation[materials.index(c)].gradients(cell, displacement);
    for (std::size_t q = 0; q < gradients.size(); ++q)
      stress.col(static_cast<Eigen::Index>(q)) = own.stress(gradients[q], warmer[q], place_for(own, cell, q));
    visit(c, cell, stress, own);
  }
}

}  // namespace

double von_mises(const Stress& s)
{
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

StressField stresses(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const Eigen::VectorXd& u,
                     Formulation formulation, const Temperature& temperature_change, std::size_t blocks)
{
  StressField field;
  field.nodal_sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.node_count()), 7 * static_cast<Eigen::Index>(blocks));
  field.cell_von_mises.resize(static_cast<Eigen::Index>(mesh.cells.size()));
  for_each_cell(mesh, materials, kinematics, formulation, temperature_change, u,
                [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity& elasticity) {
                  Stress sum = Stress::Zero();
                  double volume = 0;
                  for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
                    const Stress here = stress.col(static_cast<Eigen::Index>(q));
                    sum += cell.volumes()[q] * here;
                    volume += cell.volumes()[q];
                    field.strain_energy +=
                        0.5 * cell.volumes()[q] * elasticity.complementary(here, place_for(elasticity, cell, q));
                  }
                  field.cell_von_mises[static_cast<Eigen::Index>(c)] = von_mises(sum / volume);
                  const auto& extrapolation = cell.element().extrapolation;
                  for (int i = 0; i < cell.element().nodes; ++i) {
                    Stress at_node = Stress::Zero();
                    for (Eigen::Index q = 0; q < stress.cols(); ++q) at_node += extrapolation(i, q) * stress.col(q);
                    auto row = field.nodal_sums.row(mesh.cells[c][static_cast<std::size_t>(i)])
                                   .segment(7 * static_cast<Eigen::Index>(materials.index(c)), 7);
                    row.head(6) += volume * at_node.transpose();
                    row[6] += volume;
                  }
                });
  return field;
}

Eigen::VectorXd squared_errors(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                               const Eigen::VectorXd& u, const Eigen::MatrixXd& recovered, Formulation formulation,
                               const Temperature& temperature_change)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.cells.size()));
  Stresses nodal;  // of one cell
  for_each_cell(
      mesh, materials, kinematics, formulation, temperature_change, u,
      [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity& elasticity) {
        double& sum = result[static_cast<Eigen::Index>(c)];
        nodal.resize(6, cell.element().nodes);
        for (int i = 0; i < cell.element().nodes; ++i)
          nodal.col(i) = recovered.row(mesh.cells[c][static_cast<std::size_t>(i)])
                             .segment(6 * static_cast<Eigen::Index>(materials.index(c)), 6)
                             .transpose();
        if (cell.volumes().size() == 1) {  // one point misses what is linear in s* - s; that is a simplex with nodes 0 .. n - 1:
          // the integral of a quadratic form q of a linear function is V / (n (n + 1)) (sum of q(f_i) + q(sum of f_i)).
          const int n = cell.element().nodes;
          const Point x = place_for(elasticity, cell, 0);
          Stress total = Stress::Zero();
          double energy = 0;
          for (int i = 0; i < n; ++i) {
            const Stress difference = nodal.col(i) - stress.col(0);
            total += difference;
            energy += elasticity.complementary(difference, x);
          }
          sum = cell.volumes()[0] / (n * (n + 1)) * (energy + elasticity.complementary(total, x));
          return;
        }
        for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
          Stress difference = -stress.col(static_cast<Eigen::Index>(q));
          for (int i = 0; i < cell.element().nodes; ++i) difference += cell.element().shape[q][i] * nodal.col(i);
          sum += cell.volumes()[q] * elasticity.complementary(difference, place_for(elasticity, cell, q));
        }
      });
  return result;
}

}  // namespace mortise::fem
