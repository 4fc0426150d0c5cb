#include "fem/stress.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "cell_stress.hpp"

namespace mortise::fem {

double von_mises(const Stress& s)
{
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

StressField stresses(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const Eigen::VectorXd& u,
                     Formulation formulation, const Temperature& temperature_change, std::size_t blocks, PointStresses* points)
{
  StressField field;
  if (points) {
    std::size_t count = 0;
    for (const auto type : mesh.cells.type) count += element(type, kinematics).points();
    points->stress.reserve(count);
    points->volume.reserve(count);
  }
  field.nodal_sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.node_count()), 7 * static_cast<Eigen::Index>(blocks));
  field.cell_von_mises.resize(static_cast<Eigen::Index>(mesh.cells.size()));
  for_each_cell(mesh, materials, kinematics, formulation, temperature_change, u,
                [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity& elasticity) {
                  if (points) {
                    points->volume.insert(points->volume.end(), cell.volumes().begin(), cell.volumes().end());
                    for (Eigen::Index q = 0; q < stress.cols(); ++q) points->stress.emplace_back(stress.col(q));
                  }
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

namespace {

// The integral of d : C^-1 : d over a cell, of the difference d of `nodal` (6 x n, interpolated by the shape functions) and
// `stress` (6 x q, at the integration points that stand for `volumes`).
double squared_norm(const CellGeometry& cell, std::span<const double> volumes, const Elasticity& elasticity,
                    const Stresses& nodal, const Eigen::Map<const Stresses>& stress)
{
  double sum = 0;
  if (volumes.size() == 1) {  // one point misses what is linear in d; that is a simplex with nodes 0 .. n - 1: the integral
    // of a quadratic form q of a linear function is V / (n (n + 1)) (sum of q(f_i) + q(sum of f_i)).
    const int n = cell.element().nodes;
    const Point x = place_for(elasticity, cell, 0);
    Stress total = Stress::Zero();
    for (int i = 0; i < n; ++i) {
      const Stress difference = nodal.col(i) - stress.col(0);
      total += difference;
      sum += elasticity.complementary(difference, x);
    }
    return volumes[0] / (n * (n + 1)) * (sum + elasticity.complementary(total, x));
  }
  for (std::size_t q = 0; q < volumes.size(); ++q) {
    Stress difference = -stress.col(static_cast<Eigen::Index>(q));
    for (int i = 0; i < cell.element().nodes; ++i) difference += cell.element().shape[q][i] * nodal.col(i);
    sum += volumes[q] * elasticity.complementary(difference, place_for(elasticity, cell, q));
  }
  return sum;
}

Eigen::Map<const Stresses> all(const Stresses& stress)
{
  return {stress.data(), 6, stress.cols()};
}

// Of the nodes of a cell, one a column.
void take_nodal(std::span<const Local> nodes, std::size_t block, const Eigen::MatrixXd& stress, Stresses& nodal)
{
  nodal.resize(6, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodal.col(static_cast<Eigen::Index>(i)) = stress.row(nodes[i]).segment(6 * static_cast<Eigen::Index>(block), 6).transpose();
}

}  // namespace

Eigen::VectorXd squared_errors(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                               const Eigen::VectorXd& u, const Eigen::MatrixXd& recovered, Formulation formulation,
                               const Temperature& temperature_change)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.cells.size()));
  Stresses nodal;
  for_each_cell(mesh, materials, kinematics, formulation, temperature_change, u,
                [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity& elasticity) {
                  take_nodal(mesh.cells[c], materials.index(c), recovered, nodal);
                  result[static_cast<Eigen::Index>(c)] = squared_norm(cell, cell.volumes(), elasticity, nodal, all(stress));
                });
  return result;
}

double squared_error(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const PointStresses& points,
                     const Eigen::MatrixXd& recovered)
{
  const auto elasticity = elasticities(materials, kinematics);
  CellGeometry cell(kinematics);
  Stresses nodal;
  double sum = 0;
  std::size_t first = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    cell.gather(mesh, c);
    const auto count = cell.element().points();
    take_nodal(mesh.cells[c], materials.index(c), recovered, nodal);
    sum += squared_norm(cell, std::span(points.volume).subspan(first, count), elasticity[materials.index(c)], nodal,
                        {points.stress[first].data(), 6, static_cast<Eigen::Index>(count)});
    first += count;
  }
  return sum;
}

Eigen::VectorXd squared_errors(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                               const Eigen::VectorXd& u, const Eigen::MatrixXd& recovered, const Eigen::MatrixXd& other,
                               Formulation formulation, const Temperature& temperature_change)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.cells.size()));
  const Eigen::MatrixXd between = recovered - other;
  Stresses nodal, nothing;
  for_each_cell(mesh, materials, kinematics, formulation, temperature_change, u,
                [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity& elasticity) {
                  take_nodal(mesh.cells[c], materials.index(c), recovered, nodal);
                  double& sum = result[static_cast<Eigen::Index>(c)];
                  sum = squared_norm(cell, cell.volumes(), elasticity, nodal, all(stress));
                  take_nodal(mesh.cells[c], materials.index(c), between, nodal);
                  nothing.setZero(6, stress.cols());
                  sum += squared_norm(cell, cell.volumes(), elasticity, nodal, all(nothing));
                });
  return result;
}

Eigen::VectorXd squared_errors_of_bending(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                          const Eigen::VectorXd& u, const Temperature& temperature_change)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.cells.size()));
  const auto knows = [](mesh::CellType type) { return applies(Formulation::incompatible, type); };
  if (!std::ranges::all_of(mesh.cells.type, knows)) return result;
  for (const auto& [formulation, sign] : {std::pair(Formulation::standard, 1.0), std::pair(Formulation::incompatible, -1.0)})
    for_each_cell(
        mesh, materials, kinematics, formulation, temperature_change, u,
        [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity& elasticity) {
          for (Eigen::Index q = 0; q < stress.cols(); ++q) {
            const auto point = static_cast<std::size_t>(q);
            result[static_cast<Eigen::Index>(c)] +=
                sign * cell.volumes()[point] * elasticity.complementary(stress.col(q), place_for(elasticity, cell, point));
          }
        },
        Formulation::standard);
  return result.cwiseMax(0.0);
}

Eigen::VectorXd unseen_by_locking(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                  Formulation formulation)
{
  constexpr double compressible = 10, most = 2.2;  // bulk over shear modulus; times
  Eigen::VectorXd result = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(mesh.cells.size()));
  if (formulation != Formulation::standard || kinematics == Kinematics::plane_stress) return result;
  const Stress hydrostatic = (Stress() << 1, 1, 1, 0, 0, 0).finished(), shear = Stress::Unit(3);
  const auto elasticity = elasticities(materials, kinematics);
  CellGeometry cell(kinematics);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto type = mesh.cells.type[c];
    if (!mesh::second_order(type) || type == mesh::CellType::tri6) continue;
    const auto& law = elasticity[materials.index(c)];
    if (!law.uniform()) {
      cell.gather(mesh, c);
      cell.evaluate();
    }
    const Point at = place_for(law, cell, 0);
    const double stiffer = law.complementary(shear, at) / law.complementary(hydrostatic, at);
    result[static_cast<Eigen::Index>(c)] = std::clamp(1 + 0.5 * std::log10(stiffer / compressible), 1.0, most);
  }
  return result;
}

Eigen::VectorXd squared_errors_of_temperature(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                              Formulation formulation, const Temperature& temperature_change)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.cells.size()));
  if (!temperature_change.varying) return result;
  const auto elasticity = elasticities(materials, kinematics);
  CellGeometry cell(kinematics);
  std::vector<double> warmer, mean;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (takes_gradients(mesh.cells.type[c], formulation)) continue;
    cell.gather(mesh, c);
    cell.evaluate();
    cell_temperature(temperature_change, cell, mesh, c, false, warmer);
    cell_temperature(temperature_change, cell, mesh, c, true, mean);
    const auto& law = elasticity[materials.index(c)];
    for (std::size_t q = 0; q < warmer.size(); ++q) {
      const Point x = place_for(law, cell, q);
      result[static_cast<Eigen::Index>(c)] +=
          cell.volumes()[q] * law.complementary(law.stress(Eigen::Matrix3d::Zero(), warmer[q] - mean[q], x), x);
    }
  }
  return result;
}

}  // namespace mortise::fem
