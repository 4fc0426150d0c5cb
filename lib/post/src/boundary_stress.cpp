#include "boundary_stress.hpp"

#include <map>

#include "bem/steklov_poincare.hpp"
#include "bem/stress_recovery.hpp"
#include "bem/surface_stress.hpp"
#include "fem/stress.hpp"

namespace mortise::post {

namespace {

// The vectors of all nodes or panels, 3 each, rotated.
void rotate(const Eigen::Matrix3d& rotation, Eigen::Ref<Eigen::VectorXd> v)
{
  for (Eigen::Index i = 0; i < v.size(); i += 3) v.segment<3>(i) = rotation * Eigen::Vector3d(v.segment<3>(i));
}

}  // namespace

bem::ParticularSolution particular_solution(const ElasticBodies& bodies, std::size_t subdomain)
{
  return {bodies.constitution[subdomain], bodies.decomposition.subdomains[subdomain].mesh.points.front()};
}

std::vector<BoundaryStress> boundary_stresses(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  std::vector<BoundaryStress> result(subdomains.size());
  std::map<std::size_t, std::vector<std::size_t>> members;  // of each original
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    if (subdomains[s].skin) members[bodies.copies[s].original].push_back(s);
  for (const auto& [original, list] : members) {
    const auto reference = bem::make_panels(subdomains[original].mesh);
    Eigen::MatrixXd u(3 * reference.node_count(), static_cast<Eigen::Index>(list.size()));
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto s = list[c];
      auto column = u.col(static_cast<Eigen::Index>(c));
      column = displacement[s] - particular_solution(bodies, s).displacement(bem::make_panels(subdomains[s].mesh));
      if (const auto& rotation = bodies.copies[s].rotation) rotate(rotation->transpose(), column);
    }
    Eigen::MatrixXd t = bem::tractions(reference, bodies.constitution[original].materials[0], u);
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto s = list[c];
      const auto column = static_cast<Eigen::Index>(c);
      if (const auto& rotation = bodies.copies[s].rotation) {
        rotate(*rotation, u.col(column));
        rotate(*rotation, t.col(column));
      }
      const auto panels = bem::make_panels(subdomains[s].mesh);
      const auto particular = particular_solution(bodies, s);
      auto& own = result[s];
      own.stress = bem::panel_stresses(panels, bodies.constitution[s].materials[0], u.col(column), t.col(column));
      const Eigen::VectorXd traction = t.col(column) + particular.traction(panels);
      own.traction = traction.reshaped<Eigen::RowMajor>(panels.size(), 3);
      own.nodal_sums = Eigen::MatrixXd::Zero(panels.node_count(), 7 * static_cast<Eigen::Index>(bodies.blocks));
      auto sums = own.nodal_sums.leftCols<7>();
      sums = bem::nodal_sums(panels, bodies.constitution[s].materials[0], u.col(column), t.col(column));
      for (Eigen::Index n = 0; n < sums.rows(); ++n)
        sums.row(n).head<6>() += sums(n, 6) * particular.stress(panels.points[static_cast<std::size_t>(n)]).transpose();
      for (std::size_t p = 0; p < panels.corners.size(); ++p) {
        const auto row = static_cast<Eigen::Index>(p);
        own.stress.row(row) +=
            particular.stress((panels.corner(p, 0) + panels.corner(p, 1) + panels.corner(p, 2)) / 3).transpose();
      }
      own.surface = {u.col(column), t.col(column)};
    }
  }
  return result;
}

// Of u = e + u_p: e'S e / 2 + u_p'S e + that of u_p.
double boundary_energy(const ElasticBodies& bodies, std::size_t subdomain, const Eigen::VectorXd& displacement)
{
  const auto& s = *bodies.operators[subdomain];
  const auto particular = particular_solution(bodies, subdomain);
  if (particular.is_zero()) return displacement.dot(s.apply(displacement)) / 2;
  const auto panels = bem::make_panels(bodies.decomposition.subdomains[subdomain].mesh);
  const Eigen::VectorXd of_force = particular.displacement_of_force(panels);
  const Eigen::VectorXd rest = displacement - particular.displacement(panels);
  const Eigen::VectorXd force = s.apply(rest);
  return rest.dot(force) / 2 + of_force.dot(force) + particular.strain_energy(panels);
}

namespace {

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

}  // namespace

Eigen::VectorXd boundary_errors(const ElasticBodies& bodies, std::size_t subdomain, const BoundaryStress& found,
                                const Eigen::MatrixXd& recovered)
{
  const auto panels = bem::make_panels(bodies.decomposition.subdomains[subdomain].mesh);
  const auto& material = bodies.constitution[subdomain].materials[0];
  const double mu = material.young_modulus / (2 * (1 + material.poisson_ratio));
  Eigen::VectorXd result(panels.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    fem::Stress mean = fem::Stress::Zero();
    for (const Local node : panels.corners[p]) mean += recovered.row(node).head<6>().transpose() / 3;
    const double square = (bem::traction(mean, panels.normal[p]) - found.traction.row(row).transpose()).squaredNorm();
    result[row] = std::pow(panels.area[p], 1.5) *
                  (share_of_stress * strain_energy_density(mean - found.stress.row(row).transpose(), material) +
                   share_of_traction * square / (2 * mu));
  }
  return result;
}

}  // namespace mortise::post
