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
double estimate_errors(const feti::DualSolution& solved, const StressField& stress, const Rounding& rounding, double stored,
                       const Communicator& comm, Accuracy& accuracy)
{
  accuracy.algebraic_error = solved.solution.error;
  double squared_error = stress.squared_error;
  for (const auto& contact : accuracy.contact_errors) squared_error += contact.squared;
  const double squared_norm =
      std::max(2 * stress.strain_energy + squared_error, nothing_of_errors(rounding, solved.solution.error));
  if (!(squared_norm > 0)) return 0;  // a state at rest is exact
  const double norm = std::sqrt(std::max(squared_norm, strained * stored));
  accuracy.algebraic_error /= norm;
  accuracy.mesh_error = {std::sqrt(squared_error / squared_norm), largest_of_ranks(stress.worst_cell, comm), stress.body_error,
                         squared_norm};
  comm.sum_in_place(accuracy.mesh_error.part);
  for (auto& part : accuracy.mesh_error.part) part /= std::max(squared_error, 1e-300);
  return norm;
}

// Of this rank's secondary sides: those of contacts with friction that do not stick, ascending.
std::vector<Global> loose_nodes(std::span<const contact::Pair> pairs, std::span<const contact::SurfaceState> surfaces)
{
  std::vector<Global> nodes;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (pairs[c].options.law == contact::Law::bonded || pairs[c].options.law == contact::Law::frictionless) continue;
    const auto& ids = pairs[c].secondary.node_id;
    for (std::size_t n = 0; n < ids.size(); ++n)
      if (surfaces[c].status[n] != static_cast<int>(contact::Status::stick)) nodes.push_back(ids[n]);
  }
  std::ranges::sort(nodes);
  return nodes;
}

// What rounding leaves in this state and those before.
Rounding rounding_of(const Equilibrium& e, double largest_body, double stored, const Communicator& comm)
{
  auto result = rounding(e.displacement, e.problem.load(), e.system.nodal_stiffness, e.problem.dimension(), largest_body, comm);
  result.take(e.before);
  // An error of this size is a hundredth: it excuses residuals that are measured by what is nothing itself.
  result.energy = std::max(result.energy, std::pow(100 * e.negligible, 2));
  // Bodies that hang on springs move more exactly than they are strained.
  result.energy = std::max(result.energy, part_of_springs * stored);
  return result;
}

Forces forces_of(const Equilibrium& e, const ElasticBodies& bodies, const ContactResults& contact, const Rounding& rounding)
{
  const auto& lambda = e.solved.solution.x;
  Forces result;
  result.reactions = reactions(e.problem, lambda, e.supports);
  result.couplings = coupling_states(e.problem, lambda);
  result.springs = spring_states(e.problem, lambda);
  result.balance = balance(e.problem, lambda, result.reactions, contact.resultants, e.pairs,
                           bodies.kinematics == fem::Kinematics::axisymmetric, result.couplings, rounding);
  result.unresisted = e.problem.unresisted_loads();
  result.shortenings = e.problem.shortenings(e.solved.solution.nu);
  return result;
}

Residuals residuals_of(const Equilibrium& e, const ElasticBodies& bodies, std::span<const double> sizes, const Fields& fields,
                       const ContactResults& contact, const Rounding& rounding, const Communicator& comm)
{
  const auto& solution = e.solved.solution;
  Residuals result;
  result.projected_gradient = solution.projected_gradient;
  result.equality = solution.equality;
  result.equilibrium = e.problem.imbalance(e.displacement, solution.x, rounding.force);
  // Of heated bodies that are held all round, displacements say nothing.
  const double length = std::max({fields.max_displacement, rounding.length, free_expansion(bodies, sizes, comm)});
  const auto over = [](double value, double scale) { return scale > 0 ? value / scale : value; };
  result.penetration = over(contact.penetration, length);
  result.supports = over(distance_from_supports(e.problem, e.displacement, solution.nu), length);
  result.interfaces =
      over(distance_between_parts(e.problem, bodies.decomposition, bodies.interface, e.displacement, solution.nu), length);
  const double energy = std::max({fields.stress.strain_energy, rounding.energy, rounding.moved, rounding.work});
  result.complementarity = over(contact.work_of_gaps, 2 * energy);
  return result;
}

Neglected neglected(const Equilibrium& e, const ElasticBodies& bodies, const Fields& fields, const ContactResults& contact,
                    const Communicator& comm)
{
  const auto& lambda = e.solved.solution.x;
  Neglected result;
  if (bodies.kinematics != fem::Kinematics::axisymmetric)
    result.moments = contact_moments(e.problem, lambda, bodies.decomposition, bodies.kinematics, e.pairs, contact.states);
  auto energies = fields.stress.body_energy;
  comm.sum_in_place(energies);
  result.turn =
      large_turn(e.problem, lambda, bodies.decomposition, bodies.kinematics, e.displacement, e.pairs, contact.states, energies);
  return result;
}

}  // namespace

Results evaluate(const Equilibrium& e, const ElasticBodies& bodies, const Communicator& comm)
{
  const auto& solution = e.solved.solution;
  const auto sizes = body_sizes(bodies.decomposition, bodies.kinematics, comm);
  const auto* springs = e.problem.system().springs();
  const double stored = springs ? springs->stored(solution.x) : 0;
  const auto rounding = rounding_of(e, *std::max_element(sizes.begin(), sizes.end()), stored, comm);
  Results results;
  auto& [fields, contact, forces, accuracy, left_out, verdict] = results;
  fields.max_displacement = largest_displacement(e.displacement, e.problem.dimension(), comm);
  contact = contact_results(e.problem, solution.x, solution.nu, e.solved.slip_bounds, e.displacement, e.pairs, e.largest_force);
  fields.stress = recover_stress(bodies, e.displacement, comm, loose_nodes(e.pairs, contact.surfaces));
  accuracy.contact_errors = contact_errors(bodies, e.displacement, fields.stress, e.pairs, contact.surfaces, comm);
  const double norm = estimate_errors(e.solved, fields.stress, rounding, stored, comm, accuracy);
  left_out = neglected(e, bodies, fields, contact, comm);
  forces = forces_of(e, bodies, contact, rounding);
  accuracy.residuals = residuals_of(e, bodies, sizes, fields, contact, rounding, comm);

  Evidence evidence;
  evidence.converged = e.solved.converged;
  evidence.limit = e.solved.limit;
  evidence.tolerance = e.tolerance;
  static_cast<Residuals&>(evidence) = accuracy.residuals;
  evidence.imbalance = forces.balance.difference;
  evidence.algebraic_error = accuracy.algebraic_error;
  evidence.drift =
      drift(bodies.decomposition, bodies.kinematics, sizes, e.displacement, prescribed(e.problem.constraints(), comm), comm);
  verdict = post::verdict(evidence);
  accuracy.algebraic_error += e.problem.system().rounding();  // what the solver does not know
  if (norm > 0) accuracy.algebraic_error += e.slip_error / norm;
  return results;
}

}  // namespace mortise::post
