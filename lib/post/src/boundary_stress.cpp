#include "boundary_stress.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "bem/plane_state.hpp"
#include "bem/representation.hpp"
#include "bem/steklov_poincare.hpp"
#include "bem/stress_recovery.hpp"
#include "bem/surface_stress.hpp"
#include "fem/stress.hpp"

namespace mortise::post {

namespace {

fem::Material material_of(const ElasticBodies& bodies, std::size_t s)
{
  return bem::in_plane(bodies.constitution[s].materials[0], bodies.kinematics);
}

// The vectors of all nodes or panels, D each, rotated.
template <int D>
void rotate(const Eigen::Matrix3d& rotation, Eigen::Ref<Eigen::VectorXd> v)
{
  const Eigen::Matrix<double, D, D> turn = rotation.topLeftCorner<D, D>();
  for (Eigen::Index i = 0; i < v.size(); i += D) v.segment<D>(i) = turn * Eigen::Matrix<double, D, 1>(v.segment<D>(i));
}

// |s* n - t|^2 on each panel, s* the mean of the fits at its nodes.
Eigen::VectorXd traction_errors(const bem::PlanePanels& panels, const fem::Material& material, const Eigen::VectorXd& u,
                                const Eigen::VectorXd& t)
{
  const bem::StressRecovery recovery(panels, material);
  std::vector<fem::Stress> fit;
  for (Local n = 0; n < panels.node_count(); ++n) fit.push_back(recovery.at(n, {u, t}).constant);
  Eigen::VectorXd result(panels.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const auto [a, b] = panels.corners[p];
    const auto row = static_cast<Eigen::Index>(p);
    const fem::Stress mean = (fit[static_cast<std::size_t>(a)] + fit[static_cast<std::size_t>(b)]) / 2;
    result[row] = (bem::traction(mean, panels.normal[p]).head<2>() - t.segment<2>(2 * row)).squaredNorm();
  }
  return result;
}

// What the stress that `particular` has at x adds to `stress`, which is that of its rest.
fem::Stress complete(const ElasticBodies& bodies, std::size_t s, const bem::ParticularSolution& particular, fem::Stress stress,
                     const Point& x)
{
  stress += particular.stress(x);
  if (fem::dimension(bodies.kinematics) == 2)
    stress[2] = bem::stress_across_plane(bodies.constitution[s], bodies.kinematics, stress[0] + stress[1]);
  return stress;
}

// Of one subdomain, from what boundary elements find, u and t of its rest: all but what is recovered at the nodes.
template <int D>
BoundaryStress stress_of_skin(const ElasticBodies& bodies, std::size_t s, const bem::PanelsIn<D>& panels,
                              const Eigen::VectorXd& u, const Eigen::VectorXd& t)
{
  const auto particular = particular_solution(bodies, s);
  const auto material = material_of(bodies, s);
  BoundaryStress own;
  own.stress = bem::panel_stresses(panels, material, u, t);
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    own.stress.row(row) = complete(bodies, s, particular, own.stress.row(row).transpose(), panels.middle(p)).transpose();
  }
  if constexpr (D == 2) {
    own.interpolation_errors = bem::interpolation_errors(panels, material, u, t);
    own.traction_errors = traction_errors(panels, material, u, t);
  }
  const Eigen::VectorXd traction = t + particular.traction(panels);
  own.traction = Eigen::MatrixXd::Zero(panels.size(), 3);
  own.traction.leftCols<D>() = traction.reshaped<Eigen::RowMajor>(panels.size(), D);
  own.surface = {u, t, {}};
  return own;
}

// Nodes x 7 blocks, of the stresses of the rest at the nodes, nodes x 6.
template <int D>
Eigen::MatrixXd nodal_sums(const ElasticBodies& bodies, std::size_t s, const bem::PanelsIn<D>& panels,
                           const Eigen::MatrixXd& rest)
{
  const auto particular = particular_solution(bodies, s);
  const Eigen::VectorXd area = bem::nodal_areas(panels);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(panels.node_count(), 7 * static_cast<Eigen::Index>(bodies.blocks));
  for (Eigen::Index n = 0; n < rest.rows(); ++n) {
    const auto& x = panels.points[static_cast<std::size_t>(n)];
    sums.row(n).head<6>() = area[n] * complete(bodies, s, particular, rest.row(n).transpose(), x).transpose();
    sums(n, 6) = area[n];
  }
  return sums;
}

}  // namespace

bem::ParticularSolution particular_solution(const ElasticBodies& bodies, std::size_t subdomain)
{
  return {bodies.constitution[subdomain], bodies.decomposition.subdomains[subdomain].mesh.points.front(), bodies.kinematics};
}

namespace {

// Adds up over the pieces of each body: rows of `width` values at the nodes of skins; nothing for other subdomains. Collective.
void sum_over_pieces(const ElasticBodies& bodies, std::vector<Eigen::MatrixXd>& values, Eigen::Index width,
                     const Communicator& comm)
{
  const auto row = [&](std::size_t s, Local n) {
    return bodies.decomposition.subdomains[s].skin ? partition::row_of(values[s], n) : partition::no_row();
  };
  partition::sum_rows(bodies.decomposition, bodies.interface, width, row, comm);
}

bem::LinearStress stress_round(const bem::ParticularSolution& particular, const Point& x)
{
  bem::LinearStress result;
  result.constant = particular.stress(x);
  for (int k = 0; k < 3; ++k) result.slope.col(k) = particular.stress(x + Point::Unit(k)) - result.constant;
  return result;
}

// The force of a linear stress on a node, of whose surface `normals` is the row (bem::nodal_normals).
Point force_of(const bem::LinearStress& stress, const Eigen::RowVectorXd& normals)
{
  Point result = bem::traction(stress.constant, normals.head<3>());
  for (int k = 0; k < 3; ++k) result += bem::traction(stress.slope.col(k), normals.segment<3>(3 + 3 * k));
  return result;
}

// What is recovered at the nodes of the pieces of bodies in space: fits to the forces on the whole body, and means over its
// pieces. Collective.
void recover_at_nodes(const ElasticBodies& bodies, std::vector<BoundaryStress>& stresses, const Communicator& comm)
{
  using Row = Eigen::Matrix<double, 1, 24>;  // a linear stress
  const auto& subdomains = bodies.decomposition.subdomains;
  std::vector<std::size_t> skins;
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    if (subdomains[s].skin) skins.push_back(s);
  if (comm.max(static_cast<long long>(skins.size())) == 0) return;

  std::vector<Eigen::MatrixXd> forces(subdomains.size()), means(subdomains.size());  // forces: and normals
  for (const std::size_t s : skins) {
    const auto panels = bem::make_panels<3>(subdomains[s].mesh);
    const Eigen::VectorXd force =
        bodies.operators[s]->apply(stresses[s].surface.displacement) + particular_solution(bodies, s).nodal_forces(panels);
    forces[s].resize(panels.node_count(), 15);
    forces[s] << force.reshaped<Eigen::RowMajor>(panels.node_count(), 3), bem::nodal_normals(panels);
  }
  sum_over_pieces(bodies, forces, 15, comm);
  for (const std::size_t s : skins) {
    const auto panels = bem::make_panels<3>(subdomains[s].mesh);
    const auto particular = particular_solution(bodies, s);
    const auto& [u, t, unused] = stresses[s].surface;
    bem::SurfaceValues values{u, t, forces[s].leftCols<3>(), forces[s].rightCols<12>()};
    for (Eigen::Index n = 0; n < panels.node_count(); ++n)
      values.forces.row(n) -=
          force_of(stress_round(particular, panels.points[static_cast<std::size_t>(n)]), values.normals.row(n)).transpose();
    const auto fits = bem::recovered_stresses(panels, material_of(bodies, s), values);
    const Eigen::VectorXd area = bem::nodal_areas(panels);
    means[s].resize(panels.node_count(), 25);
    for (Eigen::Index n = 0; n < panels.node_count(); ++n) {
      const auto at = static_cast<std::size_t>(n);
      const auto own = stress_round(particular, panels.points[at]);
      const Eigen::Matrix<double, 6, 3> slope = fits[at].slope + own.slope;
      means[s].row(n) << area[n] * (fits[at].constant + own.constant).transpose(), area[n] * slope.reshaped().transpose(),
          area[n];
    }
  }
  sum_over_pieces(bodies, means, 25, comm);
  for (const std::size_t s : skins) {
    const auto panels = bem::make_panels<3>(subdomains[s].mesh);
    const auto particular = particular_solution(bodies, s);
    Eigen::MatrixXd rest(panels.node_count(), 6);
    for (Eigen::Index n = 0; n < panels.node_count(); ++n) {
      const auto own = stress_round(particular, panels.points[static_cast<std::size_t>(n)]);
      const Row mean = means[s].row(n).head<24>() / means[s](n, 24);
      const fem::Stress constant = mean.head<6>().transpose() - own.constant;
      rest.row(n) = constant.transpose();
      stresses[s].surface.recovered.push_back({constant, mean.tail<18>().reshaped(6, 3) - own.slope});
    }
    stresses[s].nodal_sums = nodal_sums(bodies, s, panels, rest);
  }
}

template <int D>
std::vector<BoundaryStress> stresses_of_skins(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                                              const Communicator& comm)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  std::vector<BoundaryStress> result(subdomains.size());
  std::map<std::size_t, std::vector<std::size_t>> members;  // of each original
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    if (subdomains[s].skin) members[bodies.copies[s].original].push_back(s);
  for (const auto& [original, list] : members) {
    const auto reference = bem::make_panels<D>(subdomains[original].mesh);
    Eigen::MatrixXd u(D * reference.node_count(), static_cast<Eigen::Index>(list.size()));
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto s = list[c];
      auto column = u.col(static_cast<Eigen::Index>(c));
      column = displacement[s] - particular_solution(bodies, s).displacement(bem::make_panels<D>(subdomains[s].mesh));
      if (const auto& rotation = bodies.copies[s].rotation) rotate<D>(rotation->transpose(), column);
    }
    Eigen::MatrixXd t = bem::tractions(reference, material_of(bodies, original), u);
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto s = list[c];
      const auto column = static_cast<Eigen::Index>(c);
      if (const auto& rotation = bodies.copies[s].rotation) {
        rotate<D>(*rotation, u.col(column));
        rotate<D>(*rotation, t.col(column));
      }
      const auto panels = bem::make_panels<D>(subdomains[s].mesh);
      result[s] = stress_of_skin<D>(bodies, s, panels, u.col(column), t.col(column));
      if constexpr (D == 2) {
        const bem::Representation<2> inside(panels, material_of(bodies, s));
        result[s].nodal_sums = nodal_sums(bodies, s, panels, inside.evaluate(panels.points, u.col(column), t.col(column)).stress);
      }
    }
  }
  if (D == 3) recover_at_nodes(bodies, result, comm);
  return result;
}

template <int D>
double energy_of_skin(const ElasticBodies& bodies, std::size_t subdomain, const Eigen::VectorXd& displacement)
{
  const auto& s = *bodies.operators[subdomain];
  const auto particular = particular_solution(bodies, subdomain);
  if (particular.is_zero()) return displacement.dot(s.apply(displacement)) / 2;
  const auto panels = bem::make_panels<D>(bodies.decomposition.subdomains[subdomain].mesh);
  const Eigen::VectorXd of_force = particular.displacement_of_force(panels);
  const Eigen::VectorXd rest = displacement - particular.displacement(panels);
  const Eigen::VectorXd force = s.apply(rest);
  return rest.dot(force) / 2 + of_force.dot(force) + particular.strain_energy(panels);
}

// Of the energies that stresses and tractions off the recovered ones have in a layer as deep as the panel is wide, such that
// estimates are 0.75 to 1.8 times the true errors of beams, punches and spheres (regression/verification/methods.py).
constexpr double share_of_stress = 0.3, share_of_traction = 0.5;

// Of an isotropic material.
double strain_energy_density(const fem::Stress& stress, const fem::Material& material)
{
  const double nu = material.poisson_ratio, trace = stress.head<3>().sum();
  return ((1 + nu) * (stress.head<3>().squaredNorm() + 2 * stress.tail<3>().squaredNorm()) - nu * trace * trace) /
         (2 * material.young_modulus);
}

template <int D>
Eigen::VectorXd errors_of_skin(const ElasticBodies& bodies, std::size_t subdomain, const BoundaryStress& found,
                               const Eigen::MatrixXd& recovered)
{
  const auto panels = bem::make_panels<D>(bodies.decomposition.subdomains[subdomain].mesh);
  const auto& material = bodies.constitution[subdomain].materials[0];
  const double mu = material.young_modulus / (2 * (1 + material.poisson_ratio));
  Eigen::VectorXd result(panels.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    fem::Stress mean = fem::Stress::Zero();
    for (const Local node : panels.corners[p]) mean += recovered.row(node).head<6>().transpose() / D;
    double square = (bem::traction(mean, panels.normal[p]) - found.traction.row(row).transpose()).squaredNorm();
    if (D == 2) square = std::max(square, found.traction_errors[row]);
    const double of_traction = square / (2 * mu), volume = std::pow(panels.area[p], D == 2 ? 2 : 1.5);
    if (D == 2)
      result[row] = volume * of_traction;
    else
      result[row] = volume * (share_of_stress * strain_energy_density(mean - found.stress.row(row).transpose(), material) +
                              share_of_traction * of_traction);
  }
  if (D == 2) result += found.interpolation_errors;
  return result;
}

}  // namespace

std::vector<BoundaryStress> boundary_stresses(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                                              const Communicator& comm)
{
  return fem::dimension(bodies.kinematics) == 2 ? stresses_of_skins<2>(bodies, displacement, comm)
                                                : stresses_of_skins<3>(bodies, displacement, comm);
}

// Of u = e + u_p: e'S e / 2 + u_p'S e + that of u_p.
double boundary_energy(const ElasticBodies& bodies, std::size_t subdomain, const Eigen::VectorXd& displacement)
{
  return fem::dimension(bodies.kinematics) == 2 ? energy_of_skin<2>(bodies, subdomain, displacement)
                                                : energy_of_skin<3>(bodies, subdomain, displacement);
}

Eigen::VectorXd boundary_errors(const ElasticBodies& bodies, std::size_t subdomain, const BoundaryStress& found,
                                const Eigen::MatrixXd& recovered)
{
  return fem::dimension(bodies.kinematics) == 2 ? errors_of_skin<2>(bodies, subdomain, found, recovered)
                                                : errors_of_skin<3>(bodies, subdomain, found, recovered);
}

}  // namespace mortise::post
