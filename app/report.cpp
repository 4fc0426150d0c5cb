#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact/cyclic.hpp"
#include "fem/stress.hpp"
#include "open_ends.hpp"
#include "post/drift.hpp"

namespace mortise {

namespace {

// Largest value over all ranks and where it is.
struct Peak {
  double value = 0;
  Point at = Point::Zero();
};

Peak over_ranks(const Peak& mine, const Communicator& comm)
{
  const double largest = comm.max(mine.value);
  // The lowest rank that has it tells where.
  const long long winner =
      comm.min(mine.value == largest ? static_cast<long long>(comm.rank()) : static_cast<long long>(comm.size()));
  std::vector<double> at(3, 0.0);
  if (winner == comm.rank()) at = {mine.at[0], mine.at[1], mine.at[2]};
  comm.sum_in_place(at);
  return {largest, Point(at[0], at[1], at[2])};
}

// Stresses averaged at the nodes of each body, material by material, and what they differ by from those of the cells.
struct Recovered {
  std::vector<Eigen::MatrixXd> nodal_stress;  // nodes x 6 blocks
  std::vector<Eigen::VectorXd> cell_von_mises;
  double squared_error = 0;  // in the energy norm, over all ranks
  post::MeshError error;     // where it is
  double strain_energy = 0;  // of the elastic strain, over all ranks
};

Point centre(const mesh::Mesh& mesh, std::size_t cell)
{
  Point sum = Point::Zero();
  for (const Local n : mesh.cells[cell]) sum += mesh.points[static_cast<std::size_t>(n)];
  return sum / static_cast<double>(mesh.cells[cell].size());
}

Recovered recover(const Deck& deck, const partition::Decomposition& decomposition, const Model& model, const LoadState& state,
                  const partition::Interface& interface, const std::vector<Eigen::VectorXd>& displacement,
                  const Communicator& comm)
{
  Recovered result;
  const auto blocks = model.most_materials();
  const auto bodies = decomposition.catalogue.bodies.size();
  result.error = {0, std::vector<post::Found>(bodies), std::vector<double>(bodies, 0.0)};
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    auto field = fem::stresses(subdomain.mesh, model.materials(subdomain), deck.kinematics, displacement[s],
                               model.formulation(subdomain), model.temperature_change(subdomain, state), blocks);
    result.strain_energy += field.strain_energy;
    result.nodal_stress.push_back(std::move(field.nodal_sums));
    result.cell_von_mises.push_back(std::move(field.cell_von_mises));
  }
  partition::sum_over_copies(decomposition, interface, result.nodal_stress, comm);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& sums = result.nodal_stress[s];
    Eigen::MatrixXd stress = Eigen::MatrixXd::Zero(sums.rows(), 6 * static_cast<Eigen::Index>(blocks));
    for (Eigen::Index n = 0; n < sums.rows(); ++n)
      for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(blocks); ++k)
        if (sums(n, 7 * k + 6) > 0) stress.row(n).segment(6 * k, 6) = sums.row(n).segment(7 * k, 6) / sums(n, 7 * k + 6);
    const auto& subdomain = decomposition.subdomains[s];
    const auto errors = fem::squared_errors(subdomain.mesh, model.materials(subdomain), deck.kinematics, displacement[s], stress,
                                            model.formulation(subdomain), model.temperature_change(subdomain, state));
    result.squared_error += errors.sum();
    result.error.part[static_cast<std::size_t>(subdomain.body)] += errors.sum();
    for (Eigen::Index c = 0; c < errors.size(); ++c)
      if (auto& worst = result.error.cells[static_cast<std::size_t>(subdomain.body)]; errors[c] > worst.value)
        worst = {errors[c], centre(subdomain.mesh, static_cast<std::size_t>(c))};
    result.nodal_stress[s] = std::move(stress);
  }
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

void recover_stress(const Deck& deck, const partition::Decomposition& decomposition, const Model& model, const LoadState& state,
                    const partition::Interface& interface, const Communicator& comm, Results& results)
{
  auto recovered = recover(deck, decomposition, model, state, interface, results.displacement, comm);
  for (const auto& stress : recovered.nodal_stress) results.nodal_stress.push_back(governing(stress));
  if (model.most_materials() > 1) {
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const auto materials = model.materials(decomposition.subdomains[s]);
      auto& blocks = results.cell_block.emplace_back();
      for (std::size_t c = 0; c < decomposition.subdomains[s].mesh.cells.size(); ++c)
        blocks.push_back(static_cast<int>(materials.place(c)));
    }
    results.material_stress = std::move(recovered.nodal_stress);
  }
  results.cell_von_mises = std::move(recovered.cell_von_mises);
  Peak peak;
  for (std::size_t s = 0; s < results.nodal_stress.size(); ++s) {
    const auto& stress = results.nodal_stress[s];
    Eigen::VectorXd von_mises(stress.rows());
    for (Eigen::Index n = 0; n < stress.rows(); ++n) {
      von_mises[n] = fem::von_mises(stress.row(n).transpose());
      if (von_mises[n] > peak.value) peak = {von_mises[n], decomposition.subdomains[s].mesh.points[static_cast<std::size_t>(n)]};
    }
    results.nodal_von_mises.push_back(std::move(von_mises));
  }
  results.summary.strain_energy = recovered.strain_energy;
  auto& estimate = results.summary.error_estimate;
  // Where nothing is strained, rounding is not the error of anything.
  const double squared_norm = std::max(2 * results.summary.strain_energy + recovered.squared_error, results.rounding_of_energy);
  if (squared_norm > 0) {
    estimate.discretization = std::sqrt(recovered.squared_error / squared_norm);
    estimate.algebraic /= std::sqrt(squared_norm);
    results.mesh_error = {estimate.discretization, post::largest_of_ranks(recovered.error.cells, comm), recovered.error.part};
    comm.sum_in_place(results.mesh_error.part);
    for (auto& part : results.mesh_error.part) part /= std::max(recovered.squared_error, 1e-300);
  } else {
    estimate.discretization = 0;  // a state at rest is exact
  }
  peak = over_ranks(peak, comm);
  results.summary.max_von_mises = peak.value;
  results.max_von_mises_at = peak.at;
}

// g of this rank's contact rows, with what cuts are drawn together.
std::vector<double> bounds(const feti::DualProblem& problem, const friction::Result& solved)
{
  auto result = problem.constraints().contacts.rows.bound;
  const auto shortenings = problem.shortenings(solved.solution.nu);
  for (std::size_t c = 0; c < shortenings.size(); ++c)
    for (const auto& [row, part] : problem.constraints().cuts[c].rows) result[row] += part * shortenings[c];
  return result;
}

// The state of this rank's contact points from the multipliers and the jumps.
void contact_states(const Deck& deck, const feti::DualProblem& problem, const friction::Result& solved, Results& results)
{
  const auto& comm = problem.communicator();
  const Vector jumps = problem.jump().apply(results.displacement);
  const auto jump = view(jumps);
  const auto lambda = view(solved.solution.x);
  const auto& scale = problem.jump().scale();
  const auto& contacts = problem.constraints().contacts;
  const auto bound = bounds(problem, solved);
  double penetration = 0, slackness = 0;
  std::vector<double> largest(deck.contacts.size(), 0.0);  // pressure of each contact
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    const auto row = problem.points()[i].normal;
    auto& pressure = largest[static_cast<std::size_t>(contacts.points[i].contact)];
    pressure = std::max(pressure, lambda[row] * scale[row] / contacts.points[i].area);
  }
  for (auto& pressure : largest) pressure = comm.max(pressure);
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    const auto& rows = problem.points()[i];
    std::vector<double> multipliers, row_jumps;
    for (Local r = rows.normal; r <= rows.normal + rows.tangents; ++r) {
      multipliers.push_back(lambda[r] * scale[r]);
      row_jumps.push_back(jump[r] / scale[r]);
      // Of the tangential rows, what moving supports and cuts contribute stands in the bound, beside the slip of the steps
      // before.
      const auto row = contacts.points[i].row + static_cast<std::size_t>(r - rows.normal);
      if (r > rows.normal) row_jumps.back() -= bound[row] - contacts.slipped_before(row);
    }
    const double limit =
        rows.disc < 0 ? 0.0 : problem.set().discs()[static_cast<std::size_t>(rows.disc)].radius * scale[rows.normal];
    results.points.push_back(contact::state_of(contacts.points[i], contacts.bonded[i], multipliers, row_jumps,
                                               bound[contacts.points[i].row], limit,
                                               1e-4 * largest[static_cast<std::size_t>(contacts.points[i].contact)]));
    if (contacts.bonded[i]) continue;
    penetration = std::max(penetration, -results.points.back().gap);
    slackness += std::abs(results.points.back().gap * multipliers[0]);
  }
  results.resultants = contact::resultants(results.points, deck.contacts.size(), comm);
  const double length = results.summary.max_displacement;
  results.summary.residuals.penetration = length > 0 ? comm.max(penetration) / length : comm.max(penetration);
  const double energy = std::max(results.summary.strain_energy, results.rounding_of_energy);
  slackness = comm.sum(slackness);
  results.summary.residuals.complementarity = energy > 0 ? slackness / (2 * energy) : slackness;
}

// Forces of the supports on the bodies, by boundary.
void reactions(const Deck& deck, const feti::DualProblem& problem, const friction::Result& solved, Results& results)
{
  std::vector<double> sums((deck.supports.size() + 1) * 3, 0.0);  // the last for an axis of revolution
  const auto lambda = view(solved.solution.x);
  const auto& held = problem.constraints().held;
  for (std::size_t i = 0; i < held.size(); ++i) {
    const auto row = problem.jump().ranges().held + static_cast<Local>(i);
    sums[static_cast<std::size_t>(held[i].support) * 3 + static_cast<std::size_t>(held[i].component)] -=
        lambda[row] * problem.jump().scale()[row];
  }
  const auto& inclined = problem.constraints().inclined;
  for (std::size_t i = 0; i < inclined.size(); ++i) {
    const auto row = problem.jump().ranges().held + static_cast<Local>(held.size() + i);
    for (const auto& share : std::span(inclined[i].shares).first(static_cast<std::size_t>(inclined[i].share_count)))
      for (std::size_t c = 0; c < 3; ++c)
        sums[static_cast<std::size_t>(share.support) * 3 + c] -= lambda[row] * problem.jump().scale()[row] * share.part[c];
  }
  const auto& contacts = problem.constraints().contacts;
  for (const auto& entry : contacts.held) {  // contact forces that go straight into supports
    const auto row = problem.jump().ranges().contacts + static_cast<Local>(entry.row);
    sums[static_cast<std::size_t>(entry.support) * 3 + static_cast<std::size_t>(entry.component)] +=
        entry.coefficient * lambda[row] * problem.jump().scale()[row];
  }
  problem.communicator().sum_in_place(sums);
  for (std::size_t s = 0; s < deck.supports.size(); ++s) {
    const std::array<double, 3> force{sums[3 * s], sums[3 * s + 1], sums[3 * s + 2]};
    results.reaction += Point(deck.axisymmetric() ? 0 : force[0], force[1], force[2]);
    results.summary.reactions.push_back({deck.supports[s].boundary, force});
  }
}

// What needs the displacements alone: their largest, the loads' sum, the largest penetration.
void sum_up(const partition::Decomposition& decomposition, const feti::DualProblem& problem, const feti::Floating& floating,
            const friction::Result& solved, Results& results)
{
  const auto& comm = problem.communicator();
  const int dimension = decomposition.catalogue.dimension;
  double largest = 0;
  std::array<double, 2> stiff{0, 0};  // sums of k |u| and k |u|^2 / 2: forces and energy if nothing moved with its neighbours
  std::vector<double> applied(3, 0.0);
  long long unknowns = 0;
  for (std::size_t s = 0; s < results.displacement.size(); ++s) {
    const auto& u = results.displacement[s];
    unknowns += u.size();
    for (Eigen::Index i = 0; i < u.size(); i += dimension) {
      const double length = u.segment(i, dimension).norm();
      const double k = floating.nodal_stiffness[s][static_cast<std::size_t>(i / dimension)];
      largest = std::max(largest, length);
      stiff[0] += k * length;
      stiff[1] += 0.5 * k * length * length;
    }
    for (Eigen::Index i = 0; i < u.size(); ++i) applied[static_cast<std::size_t>(i % dimension)] += floating.load[s][i];
  }
  comm.sum_in_place(applied);
  comm.sum_in_place(stiff);
  results.rounding_of_force = 1e-12 * stiff[0];
  results.rounding_of_energy = 1e-12 * stiff[1];
  // What pushes a ring outwards needs no support.
  results.applied = Point(floating.kinematics == fem::Kinematics::axisymmetric ? 0 : applied[0], applied[1], applied[2]);
  auto& summary = results.summary;
  summary.primal_unknowns = comm.sum(unknowns);
  summary.dual_unknowns = problem.dual_unknowns();
  summary.subdomains = decomposition.subdomain_count();
  summary.clusters = decomposition.clustered() ? decomposition.cluster_count() : 0;
  summary.kernel_dimension = problem.kernel_dimension();
  summary.bodies = static_cast<Global>(decomposition.catalogue.bodies.size());
  summary.max_displacement = comm.max(largest);
  summary.ranks = comm.size();
  summary.friction_steps = solved.steps;
  summary.outer_iterations = solved.outer_iterations;
  summary.hessian_multiplications = solved.multiplications;
  summary.residuals.projected_gradient = solved.solution.projected_gradient;
  summary.residuals.equality = solved.solution.equality;
  summary.residuals.equilibrium = problem.imbalance(results.displacement, solved.solution.x);
}

// How far supports, gaps and overlaps may move a body.
double prescribed(const constraint::Constraints& constraints, const Communicator& comm)
{
  double held = 0, gap = 0;
  for (const auto& h : constraints.held) held = std::max(held, std::abs(h.value));
  for (const auto& i : constraints.inclined) held = std::max(held, std::abs(i.value));
  for (const auto& point : constraints.contacts.points) gap = std::max(gap, std::abs(point.gap));
  return comm.max(held) + comm.max(gap);
}

// All that is known of this equilibrium, for post::verdict().
post::Evidence evidence(const Deck& deck, const friction::Result& solved, const Results& results, post::Drift drift)
{
  const auto& residuals = results.summary.residuals;
  post::Evidence e;
  e.converged = solved.converged;
  e.limit = solved.limit;
  e.tolerance = deck.solver.programme.tolerance.value.value_or(0);
  e.projected_gradient = residuals.projected_gradient;
  e.equality = residuals.equality;
  e.equilibrium = residuals.equilibrium;
  e.penetration = residuals.penetration;
  e.complementarity = residuals.complementarity;
  e.imbalance = results.imbalance;
  e.algebraic_error = results.summary.error_estimate.algebraic;
  e.drift = std::move(drift);
  return e;
}

void print_contacts(const io::StateSummary& s, Log& log)
{
  for (const auto& c : s.contacts) {
    std::string pressure;
    if (c.max_pressure > 0 || !(c.max_tension > 0))
      pressure = fmt::format("largest pressure {:.5g} ({:.5g} at one node), ", c.max_recovered_pressure, c.max_pressure);
    if (c.max_tension > 0) pressure += fmt::format("largest tension {:.5g} at one node, ", c.max_tension);
    log.line("  contact {}: force on the secondary side ({:.5g}, {:.5g}, {:.5g}), {}area {:.4g}; {} open, {} stick, {} slip",
             c.name, c.force[0], c.force[1], c.force[2], pressure, c.area, c.open, c.stick, c.slip);
  }
  for (const auto& c : s.contacts)
    if (c.preload) log.line("  preload {}: force {:.6g}, shortened by {:.6g}", c.name, c.preload->force, c.preload->shortening);
  print_open_ends(s, log);
}

}  // namespace

EnergyNorms energy_norms(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                         const LoadState& state, const partition::Interface& interface,
                         const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const auto recovered = recover(deck, decomposition, model, state, interface, displacement, comm);
  return {std::sqrt(recovered.squared_error), std::sqrt(2 * recovered.strain_energy)};
}

Results evaluate(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                 const Simulation& simulation, const Context& context)
{
  const auto& problem = simulation.problem();
  const auto& floating = simulation.floating();
  const auto& solved = simulation.solved();
  const auto& pairs = simulation.pairs();
  Results results;
  results.displacement = problem.displacement(solved.solution.x, solved.solution.nu);
  results.summary.version = MORTISE_VERSION;
  results.summary.title = deck.title;
  results.summary.error_estimate.algebraic = solved.solution.error;
  sum_up(decomposition, problem, floating, solved, results);
  recover_stress(deck, decomposition, model, simulation.state(), simulation.interface(), context.comm, results);
  contact_states(deck, problem, solved, results);
  reactions(deck, problem, solved, results);
  results.surfaces = contact::surface_states(results.points, pairs, context.comm);
  const auto tensions = post::largest_tensions(results.points, deck.contacts.size(), context.comm);
  for (std::size_t c = 0; c < deck.contacts.size(); ++c) {
    const auto& r = results.resultants[c];
    if (const auto turn = contact::turn_of(deck.contacts[c]))
      results.neighbours += r.force - turn->rotation.transpose() * r.force;
    if (deck.contacts[c].obstacle) results.obstacles += Point(deck.axisymmetric() ? 0 : r.force[0], r.force[1], r.force[2]);
    const auto largest = [&](const std::vector<double>& pressure) {
      return context.comm.max(pressure.empty() ? 0.0 : *std::max_element(pressure.begin(), pressure.end()));
    };
    results.summary.contacts.push_back({deck.contacts[c].name,
                                        {r.force[0], r.force[1], r.force[2]},
                                        std::max(largest(results.surfaces[c].pressure), 0.0),
                                        r.area,
                                        r.open,
                                        r.stick,
                                        r.slip,
                                        largest(results.surfaces[c].recovered_pressure),
                                        tensions[c]});
    const auto& gap = simulation.initial_gaps()[c];
    results.summary.contacts.back().initial_gap = {gap.smallest, gap.largest_overlap(), gap.touching_area};
  }
  const auto shortenings = problem.shortenings(solved.solution.nu);
  for (std::size_t i = 0; i < shortenings.size(); ++i) {
    const auto& cut = problem.constraints().cuts[i];
    const auto contact = static_cast<std::size_t>(cut.preload.contact);
    results.summary.contacts[contact].preload = {cut.normal.dot(results.resultants[contact].force), shortenings[i]};
  }
  add_open_ends(solved, deck, results.summary);
  double size = std::max({results.applied.norm(), results.reaction.norm(), results.rounding_of_force, 1e-300});
  for (const auto& r : results.resultants) size = std::max(size, r.force.norm());
  for (const auto& r : results.summary.reactions) size = std::max(size, std::hypot(r.force[0], r.force[1], r.force[2]));
  results.largest_force = size;
  results.gauges = problem.gauge_force(solved.solution.x);
  results.imbalance =
      (results.applied + results.reaction + results.obstacles + results.neighbours + results.gauges).norm() / size;
  results.push_of_facets = results.gauges.norm() / size;
  results.verdict = post::verdict(
      evidence(deck, solved, results,
               post::drift(decomposition, deck.kinematics, post::body_sizes(decomposition, deck.kinematics, context.comm),
                           results.displacement, prescribed(simulation.constraints(), context.comm), context.comm)));
  results.summary.converged = results.verdict.status == ExitStatus::solved;
  results.summary.exit_status = static_cast<int>(results.verdict.status);
  return results;
}

void print_step(const Results& results, const Context& context)
{
  const auto& s = results.summary.steps.back();
  print_contacts(s, context.log);
  context.log.line("  largest von Mises {:.5g}, largest displacement {:.5g}; {} products with F, {} friction steps",
                   s.max_von_mises, s.max_displacement, s.hessian_multiplications, s.friction_steps);
}

void print(const Results& results, const Context& context)
{
  auto& log = context.log;
  const auto& s = results.summary;
  const auto vector = [](const Point& p) { return fmt::format("({:.5g}, {:.5g}, {:.5g})", p[0], p[1], p[2]); };
  log.line("");
  log.line("{}", results.verdict.headline);
  if (!results.verdict.reason.empty()) log.line("  {}", results.verdict.reason);
  const auto part = [&](const char* name, const Point& force) {
    return force.isZero(0) ? "" : fmt::format("{} {}, ", name, vector(force));
  };
  log.line(
      "  balance of forces   applied {}, supports {}, {}{}difference {:.1e} of the largest force", vector(results.applied),
      vector(results.reaction), part("obstacles", results.obstacles),
      part("sectors beside", results.neighbours) + (results.push_of_facets > 1e-6 ? part("against facets", results.gauges) : ""),
      results.imbalance);
  log.line("  largest von Mises   {:.5g} at {}", s.max_von_mises, vector(results.max_von_mises_at));
  log.line("  largest displacement {:.5g}, strain energy {:.6g}", s.max_displacement, s.strain_energy);
  const auto percent = [](double part) {
    return std::isfinite(part) ? fmt::format("about {:.2g} %", 100 * part) : "not estimated";
  };
  log.line("  error               of the mesh {}, of the solver {}, in the energy norm", percent(s.error_estimate.discretization),
           percent(s.error_estimate.algebraic));
  print_contacts(s, log);
  log.line(
      "  residuals           gradient {:.1e}, equality {:.1e}, equilibrium {:.1e}, penetration {:.1e}, complementarity {:.1e}",
      s.residuals.projected_gradient, s.residuals.equality, s.residuals.equilibrium, s.residuals.penetration,
      s.residuals.complementarity);
  log.line("  work                {} products with F, {} outer iterations, {} friction steps", s.hessian_multiplications,
           s.outer_iterations, s.friction_steps);
}

}  // namespace mortise
