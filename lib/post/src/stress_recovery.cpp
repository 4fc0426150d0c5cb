#include "post/stress_recovery.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "boundary_stress.hpp"
#include "fem/patches.hpp"
#include "fem/stress.hpp"
#include "fem/symmetry.hpp"
#include "layers.hpp"

namespace mortise::post {

namespace {

// In one layer of cells of second order the error is about so many times what stresses recovered along it show: the median over
// beams and plates, clamped and loaded in several ways.
constexpr double unseen_in_a_layer = 2;
// Of first order all nodes of a layer are on its faces, and recovered shear is zero all over it. In squares the true error is a
// fifth of that, both of a bent layer, whose shear is a parabola, and of a twisted square bar.
constexpr double of_linear_shear = 0.25;
constexpr double assumed_error = 0.01;  // of boundary elements, of their part of the solution, in the energy norm

// Stresses averaged at the nodes of each body, material by material, and what they differ by from those of the cells.
struct Recovered {
  std::vector<Eigen::MatrixXd> nodal;  // nodes x 6 blocks
  std::vector<Eigen::VectorXd> cell_von_mises;
  std::vector<SurfaceField> surface;
  double squared_error = 0;  // of all ranks
  double strain_energy = 0;  // of all ranks
  std::vector<Found> worst_cell;
  std::vector<double> body_error, body_energy;
};

Point centre(const mesh::Mesh& mesh, std::size_t cell)
{
  Point sum = Point::Zero();
  for (const Local n : mesh.cells[cell]) sum += mesh.points[static_cast<std::size_t>(n)];
  return sum / static_cast<double>(mesh.cells[cell].size());
}

// Sums over all copies of nodes x 7 blocks to nodes x 6 blocks; where nothing has weight `otherwise`.
Eigen::MatrixXd means(const Eigen::MatrixXd& sums, Eigen::MatrixXd otherwise = {})
{
  const auto blocks = sums.cols() / 7;
  Eigen::MatrixXd stress = otherwise.size() > 0 ? std::move(otherwise) : Eigen::MatrixXd::Zero(sums.rows(), 6 * blocks);
  for (Eigen::Index n = 0; n < sums.rows(); ++n)
    for (Eigen::Index k = 0; k < blocks; ++k)
      if (sums(n, 7 * k + 6) > 0) stress.row(n).segment(6 * k, 6) = sums.row(n).segment(7 * k, 6) / sums(n, 7 * k + 6);
  return stress;
}

std::span<const SymmetricNode> at_copies(const ElasticBodies& bodies, std::size_t s,
                                         std::vector<std::vector<SymmetricNode>> SymmetricNodes::*nodes)
{
  if (!bodies.symmetric || (bodies.symmetric->*nodes).empty()) return {};
  return (bodies.symmetric->*nodes)[s];
}

// Adds to sums over all copies, nodes x 7 blocks of each subdomain, those of the nodes that they are one with beyond a sector's
// cut. Collective.
void add_rotated(const ElasticBodies& bodies, std::vector<Eigen::MatrixXd>& sums, const Communicator& comm)
{
  if (!bodies.symmetric || !comm.any(!bodies.symmetric->rotated.empty())) return;
  const auto& rotated = bodies.symmetric->rotated;
  const auto& decomposition = bodies.decomposition;
  struct Wanted {
    Global subdomain;
    Local node;
    int body;  // which has these materials
  };
  std::vector<std::vector<Wanted>> wanted(static_cast<std::size_t>(comm.size()));
  const auto rank_of = [&](const RotatedNode& at) { return static_cast<std::size_t>(decomposition.rank_of(at.subdomain)); };
  for (std::size_t s = 0; s < rotated.size(); ++s)
    for (const auto& at : rotated[s]) wanted[rank_of(at)].push_back({at.subdomain, at.other, decomposition.subdomains[s].body});
  const Global first = decomposition.first[static_cast<std::size_t>(comm.rank())];
  std::vector<std::vector<double>> answers;
  for (const auto& part : comm.exchange(wanted)) {
    auto& answer = answers.emplace_back();
    for (const auto& at : part) {
      const auto s = static_cast<std::size_t>(at.subdomain - first);
      Eigen::RowVectorXd row = sums[s].row(at.node);
      if (decomposition.subdomains[s].body != at.body) row.setZero();
      answer.insert(answer.end(), row.begin(), row.end());
    }
  }
  const auto found = comm.exchange(answers);
  std::vector<std::size_t> next(found.size(), 0);
  for (std::size_t s = 0; s < rotated.size(); ++s)
    for (const auto& at : rotated[s]) {
      auto& position = next[rank_of(at)];
      for (Eigen::Index k = 0; k < sums[s].cols(); k += 7, position += 7) {
        const Eigen::Map<const fem::Stress> other(found[rank_of(at)].data() + position);
        sums[s].row(at.node).segment(k, 6) += fem::rotated_stress(other, at.rotation).transpose();
        sums[s](at.node, k + 6) += found[rank_of(at)][position + 6];
      }
    }
}

// Takes the shear along planes through these nodes out of their stress, nodes x 6 blocks.
void make_symmetric(Eigen::MatrixXd& stress, std::span<const SymmetricNode> nodes)
{
  for (const auto& at : nodes)
    for (Eigen::Index k = 0; k < stress.cols(); k += 6) {
      auto own = stress.row(at.node).segment(k, 6);
      own = fem::symmetric_stress(own.transpose(), at.normals).transpose();
    }
}

// Gives the stress of these nodes, nodes x 6 blocks, the tractions across faces that are known.
void take_tractions(Eigen::MatrixXd& stress, std::span<const SymmetricNode> nodes)
{
  for (const auto& at : nodes)
    for (std::size_t i = 0; i < at.tractions.size(); ++i)
      for (Eigen::Index k = 0; k < stress.cols() && !std::isnan(at.tractions[i]); k += 6) {
        auto own = stress.row(at.node).segment(k, 6);
        own = fem::stress_with_traction(own.transpose(), at.normals[i], at.tractions[i]).transpose();
      }
}

// Goes on beyond planes of symmetry that are at right angles to each other.
void mirror_patches(const ElasticBodies& bodies, std::size_t s, fem::Patches& patches)
{
  for (const auto& at : at_copies(bodies, s, &SymmetricNodes::mirrored)) {
    if (patches.row[static_cast<std::size_t>(at.node)] < 0) continue;
    std::vector<Point> in_model;  // in plane models a turn about an axis is none
    for (const Point& n : at.normals)
      if (fem::dimension(bodies.kinematics) == 3 || n[2] == 0) in_model.push_back(n);
    const auto spaces = fem::mirrored_spaces(in_model);
    if (spaces.size() < in_model.size()) continue;
    for (const auto& space : spaces) fem::add_mirror_image(patches, at.node, space.front(), bodies.kinematics);
  }
}

// By polynomials on patches of cells (fem/patches.hpp): sums over all copies, nodes x 7 blocks of each subdomain; of boundary
// elements nothing.
std::vector<Eigen::MatrixXd> patch_sums(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                                        const Communicator& comm)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  int order = 1;
  for (const auto& subdomain : subdomains)
    if (!subdomain.skin) order = std::max(order, fem::largest_order(subdomain.mesh));
  order = static_cast<int>(comm.max(static_cast<long long>(order)));
  std::vector<fem::Patches> patches(subdomains.size());
  Eigen::Index width = 0;
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    if (!subdomains[s].skin) {
      patches[s] =
          fem::patch_sums(subdomains[s].mesh, bodies.constitution[s], bodies.kinematics, displacement[s], bodies.blocks, order);
      width = patches[s].sums.rows();
    }
  width = static_cast<Eigen::Index>(comm.max(static_cast<long long>(width)));
  const auto sums_at = [&](std::size_t s, Local n) {
    const auto row = subdomains[s].skin ? -1 : patches[s].row[static_cast<std::size_t>(n)];
    return row < 0 ? partition::no_row() : partition::column_of(patches[s].sums, row);
  };
  partition::sum_rows(bodies.decomposition, bodies.interface, width, sums_at, comm);
  std::vector<Eigen::MatrixXd> result;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    if (subdomains[s].skin) {
      result.push_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(subdomains[s].mesh.node_count()),
                                             7 * static_cast<Eigen::Index>(bodies.blocks)));
      continue;
    }
    mirror_patches(bodies, s, patches[s]);
    result.push_back(
        fem::patch_stresses(subdomains[s].mesh, bodies.constitution[s].materials, bodies.kinematics, patches[s], bodies.blocks));
    patches[s] = {};  // they are the largest of all fields
  }
  partition::sum_over_copies(bodies.decomposition, bodies.interface, result, comm);
  add_rotated(bodies, result, comm);
  return result;
}

// Adds to the squared errors of these cells of subdomain s, in one layer, what recovered stresses do not show of them.
void add_unseen(const ElasticBodies& bodies, std::size_t s, const Eigen::VectorXd& displacement,
                std::span<const std::size_t> layer, Eigen::VectorXd& squared)
{
  const auto& mesh = bodies.decomposition.subdomains[s].mesh;
  const auto& own = bodies.constitution[s];
  Eigen::VectorXd of_bending = Eigen::VectorXd::Zero(squared.size());
  if (own.formulation == fem::Formulation::standard)
    of_bending = fem::squared_errors_of_bending(mesh, own.materials, bodies.kinematics, displacement, own.temperature_change);
  for (const std::size_t c : layer) {
    double& error = squared[static_cast<Eigen::Index>(c)];
    if (mesh::second_order(mesh.cells.type[c])) error *= unseen_in_a_layer * unseen_in_a_layer;
    error += of_bending[static_cast<Eigen::Index>(c)];
  }
}

// The squared errors of the cells of subdomain s, of finite elements. Both recoveries have no shear along faces that bear none:
// in a twisted bar that is one or two cells thick nothing else tells the error, since its stresses are smooth along it. A layer
// of cells has next to no other nodes, and what bends it shows in recoveries without that.
Eigen::VectorXd squared_errors(const ElasticBodies& bodies, std::size_t s, const Eigen::VectorXd& displacement,
                               const Eigen::MatrixXd& patches, const Eigen::MatrixXd& averages)
{
  const auto& mesh = bodies.decomposition.subdomains[s].mesh;
  const auto& own = bodies.constitution[s];
  const auto squared_by = [&](const Eigen::MatrixXd& of_patches, const Eigen::MatrixXd& of_averages) {
    return fem::squared_errors(mesh, own.materials, bodies.kinematics, displacement, of_patches, of_averages, own.formulation,
                               own.temperature_change);
  };
  Eigen::MatrixXd of_patches = means(patches, averages), of_averages = averages;
  make_symmetric(of_patches, at_copies(bodies, s, &SymmetricNodes::mirrored));
  const auto layer = cells_in_a_layer(mesh, own.materials, patches);
  Eigen::VectorXd along_layer, across_layer;
  if (!layer.empty()) {
    along_layer = squared_by(of_patches, of_averages);
    add_unseen(bodies, s, displacement, layer, along_layer);
    Eigen::MatrixXd with_tractions = of_averages;
    take_tractions(with_tractions, at_copies(bodies, s, &SymmetricNodes::shear_free));
    across_layer = fem::squared_errors(mesh, own.materials, bodies.kinematics, displacement, with_tractions, own.formulation,
                                       own.temperature_change);
  }
  for (auto* stress : {&of_patches, &of_averages}) make_symmetric(*stress, at_copies(bodies, s, &SymmetricNodes::shear_free));
  Eigen::VectorXd result = squared_by(of_patches, of_averages);
  for (const std::size_t c : layer) {
    auto& squared = result[static_cast<Eigen::Index>(c)];
    if (!mesh::second_order(mesh.cells.type[c]))
      squared = std::max(of_linear_shear * squared, across_layer[static_cast<Eigen::Index>(c)]);
    squared = std::max(squared, along_layer[static_cast<Eigen::Index>(c)]);
  }
  result.array() *= fem::unseen_by_locking(mesh, own.materials, bodies.kinematics, own.formulation).array().square();
  return result.cwiseMax(
      fem::squared_errors_of_temperature(mesh, own.materials, bodies.kinematics, own.formulation, own.temperature_change));
}

Recovered recover(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm,
                  std::span<const Global> loose)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  const auto blocks = bodies.blocks;
  const auto body_count = bodies.decomposition.catalogue.bodies.size();
  Recovered result;
  result.worst_cell.resize(body_count);
  result.body_error.resize(body_count, 0.0);
  result.body_energy.resize(body_count, 0.0);
  const auto add_energy = [&](std::size_t s, double energy) {
    result.strain_energy += energy;
    result.body_energy[static_cast<std::size_t>(subdomains[s].body)] += energy;
  };
  auto boundary = boundary_stresses(bodies, displacement, comm);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& own = bodies.constitution[s];
    if (subdomains[s].skin) {
      add_energy(s, boundary_energy(bodies, s, displacement[s]));
      result.nodal.push_back(boundary[s].nodal_sums);
      auto& von_mises = result.cell_von_mises.emplace_back(boundary[s].stress.rows());
      for (Eigen::Index p = 0; p < von_mises.size(); ++p) von_mises[p] = fem::von_mises(boundary[s].stress.row(p).transpose());
      continue;
    }
    auto field = fem::stresses(subdomains[s].mesh, own.materials, bodies.kinematics, displacement[s], own.formulation,
                               own.temperature_change, blocks);
    add_energy(s, field.strain_energy);
    result.nodal.push_back(std::move(field.nodal_sums));
    result.cell_von_mises.push_back(std::move(field.cell_von_mises));
  }
  partition::sum_over_copies(bodies.decomposition, bodies.interface, result.nodal, comm);
  add_rotated(bodies, result.nodal, comm);
  const auto patches = patch_sums(bodies, displacement, comm);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    result.nodal[s] = means(result.nodal[s]);
    make_symmetric(result.nodal[s], at_copies(bodies, s, &SymmetricNodes::mirrored));
  }
  const auto of_held_sides = errors_between_held_sides(bodies, displacement, patches, result.nodal, loose, comm);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& mesh = subdomains[s].mesh;
    const auto body = static_cast<std::size_t>(subdomains[s].body);
    Eigen::VectorXd errors = subdomains[s].skin ? boundary_errors(bodies, s, boundary[s], result.nodal[s])
                                                : squared_errors(bodies, s, displacement[s], patches[s], result.nodal[s]);
    if (of_held_sides[s].size() > 0) errors = errors.cwiseMax(of_held_sides[s]);
    result.squared_error += errors.sum();
    result.body_error[body] += errors.sum();
    for (Eigen::Index c = 0; c < errors.size(); ++c)
      if (auto& worst = result.worst_cell[body]; errors[c] > worst.value)
        worst = {errors[c], centre(mesh, static_cast<std::size_t>(c))};
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
                           const Communicator& comm, std::span<const Global> loose)
{
  auto recovered = recover(bodies, displacement, comm, loose);
  const auto& subdomains = bodies.decomposition.subdomains;
  StressField field;
  if (bodies.blocks == 1) {
    field.nodal = std::move(recovered.nodal);
  } else {
    for (const auto& stress : recovered.nodal) field.nodal.push_back(governing(stress));
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
  field.body_energy = std::move(recovered.body_energy);
  return field;
}

EnergyNorms energy_norms(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  double squared_error = 0, strain_energy = 0;
  std::vector<Eigen::MatrixXd> nodal;
  std::vector<fem::PointStresses> points(subdomains.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    if (subdomains[s].skin) {
      const double energy = boundary_energy(bodies, s, displacement[s]);
      strain_energy += energy;
      squared_error += assumed_error * assumed_error * 2 * energy;
      nodal.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(subdomains[s].mesh.node_count()),
                                               7 * static_cast<Eigen::Index>(bodies.blocks)));
      continue;
    }
    const auto& own = bodies.constitution[s];
    auto field = fem::stresses(subdomains[s].mesh, own.materials, bodies.kinematics, displacement[s], own.formulation,
                               own.temperature_change, bodies.blocks, &points[s]);
    strain_energy += field.strain_energy;
    nodal.push_back(std::move(field.nodal_sums));
  }
  partition::sum_over_copies(bodies.decomposition, bodies.interface, nodal, comm);
  add_rotated(bodies, nodal, comm);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    if (subdomains[s].skin) continue;
    Eigen::MatrixXd stress = means(nodal[s]);
    make_symmetric(stress, at_copies(bodies, s, &SymmetricNodes::mirrored));
    squared_error +=
        fem::squared_error(subdomains[s].mesh, bodies.constitution[s].materials, bodies.kinematics, points[s], stress);
  }
  return {std::sqrt(comm.sum(squared_error)), std::sqrt(2 * comm.sum(strain_energy))};
}

}  // namespace mortise::post
