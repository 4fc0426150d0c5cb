#include "post/results.hpp"

#include <algorithm>
#include <cmath>

#include "post/compatibility.hpp"
#include "post/drift.hpp"

namespace mortise::post {

double largest_displacement(const std::vector<Eigen::VectorXd>& displacement, int dimension, const Communicator& comm)
{
  double largest = 0;
  for (const auto& u : displacement)
    for (Eigen::Index i = 0; i < u.size(); i += dimension) largest = std::max(largest, u.segment(i, dimension).norm());
  return comm.max(largest);
}

namespace {

// Of twice what springs store: energy that is nothing, and below which bodies that hang on them are not strained, as the solver's
// goals have it.
constexpr double part_of_springs = 1e-10, strained = 1e-6;

// How far supports, gaps and overlaps may move a body.
double prescribed(const constraint::Constraints& constraints, const Communicator& comm)
{
  double prescribed = 0, gap = 0;
  for (const auto& h : constraints.prescribed) prescribed = std::max(prescribed, std::abs(h.value));
  for (const auto& i : constraints.skew_supports) prescribed = std::max(prescribed, std::abs(i.value));
  for (const auto& node : constraints.contacts.nodes) gap = std::max(gap, std::abs(node.gap));
  return comm.max(prescribed) + comm.max(gap);
}

// How far bodies would expand if nothing held them.
double free_expansion(const ElasticBodies& bodies, std::span<const double> sizes, const Communicator& comm)
{
  double longest = 0;
  for (std::size_t s = 0; s < bodies.constitution.size(); ++s) {
    const auto& [materials, formulation, change, acceleration] = bodies.constitution[s];
    if (!change.any()) continue;
    const auto& subdomain = bodies.decomposition.subdomains[s];
    double degrees = std::abs(change.uniform), strain = 0;
    if (change.varying)
      for (const auto& point : subdomain.mesh.points) degrees = std::max(degrees, std::abs(change.varying(point)));
    for (std::size_t i = 0; i < materials.count(); ++i) {
      const auto& material = materials[i];
      strain = std::max(strain, std::abs(material.thermal_expansion));
      if (material.orthotropic && material.orthotropic->thermal_expansion)
        for (const double along : *material.orthotropic->thermal_expansion) strain = std::max(strain, std::abs(along));
    }
    longest = std::max(longest, degrees * strain * sizes[static_cast<std::size_t>(subdomain.body)]);
  }
  return comm.max(longest);
}

// Twice an energy below which nothing is strained: rounding is not the error of anything. Where bodies moved the solver's error
// says what is nothing: they may be strained by next to nothing of the way that supports take them, and that well.
double nothing_of_errors(const Rounding& rounding, double error)
{
  constexpr double rounding_of_motion = 1e-8;  // of Rounding::moved
  const double unstrained = std::pow(100 * error, 2);
  const double moved = std::isfinite(unstrained) ? std::min(rounding.moved, unstrained) : rounding.moved;
  return std::max({rounding.energy, moved, rounding_of_motion * rounding.moved});
}

// Relative errors of the mesh and of the solver; `stored`: twice what springs store. Returns what the solver's are relative to.
double estimate_errors(const feti::DualSolution& solved, const Rounding& rounding, double stored, const Communicator& comm,
                       Results& results)
{
  const auto& stress = results.stress;
  results.algebraic_error = solved.solution.error;
  double squared_error = stress.squared_error;
  for (const auto& contact : results.contact_errors) squared_error += contact.squared;
  const double squared_norm =
      std::max(2 * stress.strain_energy + squared_error, nothing_of_errors(rounding, solved.solution.error));
  if (!(squared_norm > 0)) return 0;  // a state at rest is exact
  const double norm = std::sqrt(std::max(squared_norm, strained * stored));
  results.algebraic_error /= norm;
  results.mesh_error = {std::sqrt(squared_error / squared_norm), largest_of_ranks(stress.worst_cell, comm), stress.body_error,
                        squared_norm};
  comm.sum_in_place(results.mesh_error.part);
  for (auto& part : results.mesh_error.part) part /= std::max(squared_error, 1e-300);
  return norm;
}

}  // namespace

Results evaluate(const Equilibrium& equilibrium, const ElasticBodies& bodies, const Communicator& comm)
{
  const auto& [problem, system, pairs, solved, displacement, supports, tolerance, negligible, before, largest_force, slip_error] =
      equilibrium;
  const auto& lambda = solved.solution.x;
  const auto& nu = solved.solution.nu;
  const int dimension = problem.dimension();
  const auto sizes = body_sizes(bodies.decomposition, bodies.kinematics, comm);
  auto rounding = post::rounding(displacement, problem.load(), system.nodal_stiffness, dimension,
                                 *std::max_element(sizes.begin(), sizes.end()), comm);
  rounding.take(before);
  // An error of this size is a hundredth: it excuses residuals that are measured by what is nothing itself.
  rounding.energy = std::max(rounding.energy, std::pow(100 * negligible, 2));
  // Bodies that hang on springs move more exactly than they are strained.
  const double stored = problem.system().springs() ? problem.system().springs()->stored(lambda) : 0;
  rounding.energy = std::max(rounding.energy, part_of_springs * stored);
  Results results;
  results.max_displacement = largest_displacement(displacement, dimension, comm);
  results.stress = recover_stress(bodies, displacement, comm);
  results.contact = contact_results(problem, lambda, nu, solved.slip_bounds, displacement, pairs, largest_force);
  results.contact_errors = contact_errors(bodies, displacement, results.stress, pairs, results.contact.surfaces, comm);
  const double norm = estimate_errors(solved, rounding, stored, comm, results);
  if (bodies.kinematics != fem::Kinematics::axisymmetric)
    results.moments = contact_moments(problem, lambda, bodies.decomposition, bodies.kinematics, pairs, results.contact.states);
  auto energies = results.stress.body_energy;
  comm.sum_in_place(energies);
  results.turn =
      large_turn(problem, lambda, bodies.decomposition, bodies.kinematics, displacement, pairs, results.contact.states, energies);
  results.reactions = reactions(problem, lambda, supports);
  results.couplings = coupling_states(problem, lambda);
  results.springs = spring_states(problem, lambda);
  results.balance = balance(problem, lambda, results.reactions, results.contact.resultants, pairs,
                            bodies.kinematics == fem::Kinematics::axisymmetric, results.couplings, rounding);
  results.unresisted = problem.unresisted_loads();
  results.shortenings = problem.shortenings(nu);

  auto& residuals = results.residuals;
  residuals.projected_gradient = solved.solution.projected_gradient;
  residuals.equality = solved.solution.equality;
  residuals.equilibrium = problem.imbalance(displacement, lambda, rounding.force);
  // Of heated bodies that are held all round, displacements say nothing.
  const double length = std::max({results.max_displacement, rounding.length, free_expansion(bodies, sizes, comm)});
  residuals.penetration = length > 0 ? results.contact.penetration / length : results.contact.penetration;
  const double off = distance_from_supports(problem, displacement, nu);
  residuals.supports = length > 0 ? off / length : off;
  const double apart = distance_between_parts(problem, bodies.decomposition, bodies.interface, displacement, nu);
  residuals.interfaces = length > 0 ? apart / length : apart;
  const double energy = std::max({results.stress.strain_energy, rounding.energy, rounding.moved, rounding.work});
  residuals.complementarity = energy > 0 ? results.contact.work_of_gaps / (2 * energy) : results.contact.work_of_gaps;

  Evidence evidence;
  evidence.converged = solved.converged;
  evidence.limit = solved.limit;
  evidence.tolerance = tolerance;
  static_cast<Residuals&>(evidence) = residuals;
  evidence.imbalance = results.balance.difference;
  evidence.algebraic_error = results.algebraic_error;
  evidence.drift =
      drift(bodies.decomposition, bodies.kinematics, sizes, displacement, prescribed(problem.constraints(), comm), comm);
  results.verdict = verdict(evidence);
  results.algebraic_error += problem.system().rounding();  // what the solver does not know
  if (norm > 0) results.algebraic_error += slip_error / norm;
  return results;
}

}  // namespace mortise::post
