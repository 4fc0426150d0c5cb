#include "post/stress_recovery.hpp"

#include <cmath>

#include "boundary_stress.hpp"
#include "fem/stress.hpp"

namespace mortise::post {

namespace {

constexpr double assumed_error = 0.01;  // of boundary elements, of their part of the solution, in the energy norm

// Stresses averaged at the nodes of each body, material by material, and what they differ by from those of the cells.
struct Recovered {
  std::vector<Eigen::MatrixXd> nodal;  // nodes x 6 blocks
  std::vector<Eigen::VectorXd> cell_von_mises;
  std::vector<SurfaceField> surface;
  double squared_error = 0;  // of all ranks
  double strain_energy = 0;  // of all ranks
  std::vector<Found> worst_cell;
  std::vector<double> body_error;
};

Point centre(const mesh::Mesh& mesh, std::size_t cell)
{
  Point sum = Point::Zero();
  for (const Local n : mesh.cells[cell]) sum += mesh.points[static_cast<std::size_t>(n)];
  return sum / static_cast<double>(mesh.cells[cell].size());
}

// Whether the stresses of boundary elements are recovered, or their errors assumed.
enum class Boundary { recovered, assumed };

Recovered recover(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm,
                  Boundary way)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  const auto blocks = bodies.blocks;
  const auto body_count = bodies.decomposition.catalogue.bodies.size();
  Recovered result;
  result.worst_cell.resize(body_count);
  result.body_error.resize(body_count, 0.0);
  std::vector<BoundaryStress> boundary;
  if (way == Boundary::recovered) boundary = boundary_stresses(bodies, displacement);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& own = bodies.constitution[s];
    if (subdomains[s].skin) {
      const double energy = boundary_energy(bodies, s, displacement[s]);
      result.strain_energy += energy;
      if (way == Boundary::assumed) {
        result.squared_error += assumed_error * assumed_error * 2 * energy;
        result.nodal.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(subdomains[s].mesh.node_count()),
                                                        7 * static_cast<Eigen::Index>(blocks)));
        result.cell_von_mises.emplace_back();
        continue;
      }
      result.nodal.push_back(boundary[s].nodal_sums);
      auto& von_mises = result.cell_von_mises.emplace_back(boundary[s].stress.rows());
      for (Eigen::Index p = 0; p < von_mises.size(); ++p) von_mises[p] = fem::von_mises(boundary[s].stress.row(p).transpose());
      continue;
    }
    auto field = fem::stresses(subdomains[s].mesh, own.materials, bodies.kinematics, displacement[s], own.formulation,
                               own.temperature_change, blocks);
    result.strain_energy += field.strain_energy;
    result.nodal.push_back(std::move(field.nodal_sums));
    result.cell_von_mises.push_back(std::move(field.cell_von_mises));
  }
  partition::sum_over_copies(bodies.decomposition, bodies.interface, result.nodal, comm);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    if (subdomains[s].skin && way == Boundary::assumed) continue;
    const auto& sums = result.nodal[s];
    Eigen::MatrixXd stress = Eigen::MatrixXd::Zero(sums.rows(), 6 * static_cast<Eigen::Index>(blocks));
    for (Eigen::Index n = 0; n < sums.rows(); ++n)
      for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(blocks); ++k)
        if (sums(n, 7 * k + 6) > 0) stress.row(n).segment(6 * k, 6) = sums.row(n).segment(7 * k, 6) / sums(n, 7 * k + 6);
    const auto& mesh = subdomains[s].mesh;
    const auto body = static_cast<std::size_t>(subdomains[s].body);
    const auto& own = bodies.constitution[s];
    const auto errors = subdomains[s].skin ? boundary_errors(bodies, s, boundary[s], stress)
                                           : fem::squared_errors(mesh, own.materials, bodies.kinematics, displacement[s], stress,
                                                                 own.formulation, own.temperature_change);
    result.squared_error += errors.sum();
    result.body_error[body] += errors.sum();
    for (Eigen::Index c = 0; c < errors.size(); ++c)
      if (auto& worst = result.worst_cell[body]; errors[c] > worst.value)
        worst = {errors[c], centre(mesh, static_cast<std::size_t>(c))};
    result.nodal[s] = std::move(stress);
  }
  for (auto& found : boundary) result.surface.push_back(std::move(found.surface));
  result.squared_error = comm.sum(result.squared_error);
  result.strain_energy = comm.sum(result.strain_energy);
  return result;
}

// Of each node's stresses, one a material, that with the largest von Mises stress.
Eigen::MatrixXd governing(const Eigen::MatrixXd& stress)
{
  Eigen::MatrixXd result = stress.leftCols(6);
  for (Eigen::Index n = 0; n < stress.rows(); ++n)
    for (Eigen::Index k = 1; 6 * k < stress.cols(); ++k)
      if (fem::von_mises(stress.row(n).segment(6 * k, 6).transpose()) > fem::von_mises(result.row(n).transpose()))
        result.row(n) = stress.row(n).segment(6 * k, 6);
  return result;
}

}  // namespace

StressField recover_stress(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                           const Communicator& comm)
{
  auto recovered = recover(bodies, displacement, comm, Boundary::recovered);
  const auto& subdomains = bodies.decomposition.subdomains;
  StressField field;
  for (const auto& stress : recovered.nodal) field.nodal.push_back(governing(stress));
  if (bodies.blocks > 1) {
    for (std::size_t s = 0; s < subdomains.size(); ++s) {
      auto& blocks = field.cell_block.emplace_back();
      for (std::size_t c = 0; c < subdomains[s].mesh.cells.size(); ++c)
        blocks.push_back(static_cast<int>(bodies.constitution[s].materials.index(c)));
    }
    field.by_material = std::move(recovered.nodal);
  }
  Found largest{0, Point::Zero()};
  for (std::size_t s = 0; s < field.nodal.size(); ++s) {
    const auto& stress = field.nodal[s];
    Eigen::VectorXd von_mises(stress.rows());
    for (Eigen::Index n = 0; n < stress.rows(); ++n) {
      von_mises[n] = fem::von_mises(stress.row(n).transpose());
      largest.take(von_mises[n], subdomains[s].mesh.points[static_cast<std::size_t>(n)], subdomains[s].body);
    }
    field.nodal_von_mises.push_back(std::move(von_mises));
  }
  field.largest_von_mises = largest_of_ranks({largest}, comm).front();
  field.cell_von_mises = std::move(recovered.cell_von_mises);
  field.surface = std::move(recovered.surface);
  field.strain_energy = recovered.strain_energy;
  field.squared_error = recovered.squared_error;
  field.worst_cell = std::move(recovered.worst_cell);
  field.body_error = std::move(recovered.body_error);
  return field;
}

EnergyNorms energy_norms(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const auto recovered = recover(bodies, displacement, comm, Boundary::assumed);
  return {std::sqrt(recovered.squared_error), std::sqrt(2 * recovered.strain_energy)};
}

}  // namespace mortise::post
