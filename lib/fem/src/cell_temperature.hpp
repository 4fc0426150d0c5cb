// The temperature that a cell's strains are counted from.
#pragma once

#include "fem/stiffness.hpp"
#include "fem/temperature.hpp"
#include "geometry.hpp"

namespace mortise::fem {

/// Whether strains may vary in a cell as a temperature does that varies linearly: see add_expansion().
inline bool takes_gradients(mesh::CellType type, Formulation formulation)
{
  return mesh::second_order(type) || (formulation == Formulation::incompatible && applies(formulation, type));
}

/// Degrees at the integration points of cell c, which `cell` was evaluated for, or everywhere their mean.
inline const std::vector<double>& cell_temperature(const Temperature& temperature, const CellGeometry& cell,
                                                   const mesh::Mesh& mesh, std::size_t c, bool mean, std::vector<double>& values)
{
  const auto& volumes = cell.volumes();
  values.assign(volumes.size(), temperature.uniform);
  if (!temperature.varying) return values;
  double sum = 0, volume = 0;
  for (std::size_t q = 0; q < volumes.size(); ++q) {
    Point x = Point::Zero();
    for (std::size_t i = 0; i < mesh.cells[c].size(); ++i)
      x += cell.element().shape[q][static_cast<Eigen::Index>(i)] * mesh.points[static_cast<std::size_t>(mesh.cells[c][i])];
    values[q] += temperature.varying(x);
    sum += volumes[q] * values[q];
    volume += volumes[q];
  }
  if (mean) values.assign(volumes.size(), sum / volume);
  return values;
}

}  // namespace mortise::fem
