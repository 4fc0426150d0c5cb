#include "fem/stress.hpp"

#include <cmath>

#include "cell_temperature.hpp"
#include "fem/stiffness.hpp"
#include "formulation.hpp"

namespace mortise::fem {

namespace {

// Stress from the displacement gradient H = du_i/dx_j and the strain that has none.
Stress stress_of(const Eigen::Matrix3d& h, const Lame& constants, Kinematics kinematics, double free_strain)
{
  Eigen::Matrix3d strain = 0.5 * (h + h.transpose());
  strain.diagonal().head(kinematics == Kinematics::plane_stress ? 2 : 3).array() -= free_strain;
  Eigen::Matrix3d s = constants.lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * constants.mu * strain;
  if (kinematics == Kinematics::plane_stress) s(2, 2) = 0;
  return (Stress() << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)).finished();
}

// s : C^-1 : s of isotropic elasticity. It serves the plane states as well, because the stress across the plane is among the six.
double complementary_energy(const Stress& s, const Material& material)
{
  const double trace = s[0] + s[1] + s[2], product = s.head<3>().squaredNorm() + 2 * s.tail<3>().squaredNorm();
  return ((1 + material.poisson_ratio) * product - material.poisson_ratio * trace * trace) / material.young_modulus;
}

// Calls visit(c, cell, stress) for every cell c; stress is q x 6.
template <class Visit>
void for_each_cell(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, Formulation formulation,
                   const Temperature& temperature_change, const Eigen::VectorXd& u, const Visit& visit)
{
  const int d = dimension(kinematics);
  std::vector<Lame> constants;
  std::vector<CellFormulation> cell_formulation;
  for (std::size_t m = 0; m < materials.count(); ++m) {
    constants.push_back(lame(materials[m], kinematics));
    cell_formulation.emplace_back(formulation, constants.back(), kinematics);
  }
  CellGeometry cell(kinematics);
  Eigen::MatrixXd displacement, stress;
  std::vector<double> warmer;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    cell.gather(mesh, c);
    cell.evaluate();
    displacement.resize(d, cell.element().nodes);
    for (int i = 0; i < cell.element().nodes; ++i) displacement.col(i) = u.segment(nodes[static_cast<std::size_t>(i)] * d, d);
    stress.resize(static_cast<Eigen::Index>(cell.volumes().size()), 6);
    const double expansion = materials[materials.index(c)].thermal_expansion;
    cell_temperature(temperature_change, cell, mesh, c, warmer);
    const auto& gradients = cell_formulation[materials.index(c)].gradients(cell, displacement);
    for (std::size_t q = 0; q < gradients.size(); ++q)
      stress.row(static_cast<Eigen::Index>(q)) =
          stress_of(gradients[q], constants[materials.index(c)], kinematics, expansion * warmer[q]).transpose();
    visit(c, cell, stress);
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
                [&](std::size_t c, const CellGeometry& cell, const Eigen::MatrixXd& stress) {
                  Stress sum = Stress::Zero();
                  double volume = 0;
                  for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
                    sum += cell.volumes()[q] * stress.row(static_cast<Eigen::Index>(q)).transpose();
                    volume += cell.volumes()[q];
                    field.strain_energy +=
                        0.5 * cell.volumes()[q] *
                        complementary_energy(stress.row(static_cast<Eigen::Index>(q)).transpose(), materials[materials.index(c)]);
                  }
                  field.cell_von_mises[static_cast<Eigen::Index>(c)] = von_mises(sum / volume);
                  for (int i = 0; i < cell.element().nodes; ++i) {
                    auto row = field.nodal_sums.row(mesh.cells[c][static_cast<std::size_t>(i)])
                                   .segment(7 * static_cast<Eigen::Index>(materials.index(c)), 7);
                    row.head(6) += volume * cell.element().extrapolation.row(i).lazyProduct(stress);
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
  for_each_cell(
      mesh, materials, kinematics, formulation, temperature_change, u,
      [&](std::size_t c, const CellGeometry& cell, const Eigen::MatrixXd& stress) {
        double& sum = result[static_cast<Eigen::Index>(c)];
        const auto& material = materials[materials.index(c)];
        const auto own = recovered.middleCols(6 * static_cast<Eigen::Index>(materials.index(c)), 6);
        if (cell.volumes().size() == 1) {  // one point misses what is linear in s* - s; that is a simplex with nodes 0 .. n - 1:
          // the integral of a quadratic form q of a linear function is V / (n (n + 1)) (sum of q(f_i) + q(sum of f_i)).
          const int n = cell.element().nodes;
          Stress total = Stress::Zero();
          double energy = 0;
          for (const Local node : mesh.cells[c]) {
            const Stress difference = (own.row(node) - stress.row(0)).transpose();
            total += difference;
            energy += complementary_energy(difference, material);
          }
          sum = cell.volumes()[0] / (n * (n + 1)) * (energy + complementary_energy(total, material));
          return;
        }
        for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
          Stress difference = -stress.row(static_cast<Eigen::Index>(q)).transpose();
          for (int i = 0; i < cell.element().nodes; ++i)
            difference += cell.element().shape[q][i] * own.row(mesh.cells[c][static_cast<std::size_t>(i)]).transpose();
          sum += cell.volumes()[q] * complementary_energy(difference, material);
        }
      });
  return result;
}

}  // namespace mortise::fem
