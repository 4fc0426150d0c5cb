// The stresses at the integration points of each cell of a piece, which recovery, patches and error estimates start from.
#pragma once

#include <optional>
#include <vector>

#include "cell_temperature.hpp"
#include "elasticity.hpp"
#include "fem/stiffness.hpp"
#include "fem/stress.hpp"
#include "formulation.hpp"

namespace mortise::fem {

using Stresses = Eigen::Matrix<double, 6, Eigen::Dynamic>;  // one a column

// Where point q of a cell is, for a law that wants to know.
inline Point place_for(const Elasticity& elasticity, const CellGeometry& cell, std::size_t q)
{
  return elasticity.uniform() ? Point::Zero() : place_of(cell, q);
}

// Of each material.
inline std::vector<Elasticity> elasticities(const Materials& materials, Kinematics kinematics)
{
  std::vector<Elasticity> result;
  for (std::size_t m = 0; m < materials.count(); ++m) result.emplace_back(materials[m], kinematics);
  return result;
}

// Calls visit(c, cell, stress, elasticity) for every cell c; stress is 6 x q. `taken`: the formulation whose temperatures it
// takes, if that is another one.
template <class Visit>
void for_each_cell(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, Formulation formulation,
                   const Temperature& temperature_change, const Eigen::VectorXd& u, const Visit& visit,
                   std::optional<Formulation> taken = {})
{
  const int d = dimension(kinematics);
  const auto elasticity = elasticities(materials, kinematics);
  std::vector<CellFormulation> cell_formulation;
  for (const auto& law : elasticity) cell_formulation.emplace_back(formulation, law, kinematics);
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
    cell_temperature(temperature_change, cell, mesh, c, !takes_gradients(mesh.cells.type[c], taken.value_or(formulation)),
                     warmer);
    const auto& gradients = cell_formulation[materials.index(c)].gradients(cell, displacement, warmer);
    for (std::size_t q = 0; q < gradients.size(); ++q)
      stress.col(static_cast<Eigen::Index>(q)) = own.stress(gradients[q], warmer[q], place_for(own, cell, q));
    visit(c, cell, stress, own);
  }
}

}  // namespace mortise::fem
