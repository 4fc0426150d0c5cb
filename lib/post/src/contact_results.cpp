#include "post/contact_results.hpp"

#include <algorithm>
#include <cmath>

#include "contact_bounds.hpp"
#include "post/strength.hpp"

namespace mortise::post {

namespace {

// A point is open while its pressure is at most this part of the largest of its contact.
constexpr double nothing = 1e-4;
// Of the largest force: contacts with less bear the rounding of an unloaded state, which differs by ranks.
constexpr double rounding_of_forces = 1e-10;

// Forces of the rows, those of contacts without any set to 0. Collective.
Eigen::VectorXd forces_of_rows(const feti::DualProblem& problem, const Vector& lambda, std::size_t contacts, double largest_force)
{
  const auto& comm = problem.communicator();
  Eigen::VectorXd forces = problem.forces(lambda);
  const auto& nodes = problem.constraints().contacts;
  const auto of_node = [&](std::size_t i) {
    const auto& rows = problem.node_rows()[i];
    return forces.segment(rows.normal, 1 + rows.tangents);
  };
  const double largest = std::max(largest_force, comm.max(forces.size() > 0 ? forces.lpNorm<Eigen::Infinity>() : 0.0));
  std::vector<double> most(contacts, 0.0);  // of each contact
  for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
    auto& force = most[static_cast<std::size_t>(nodes.nodes[i].contact)];
    force = std::max(force, of_node(i).lpNorm<Eigen::Infinity>());
  }
  for (auto& force : most) force = comm.max(force);
  for (std::size_t i = 0; i < nodes.nodes.size(); ++i)
    if (!nodes.bonded[i] && most[static_cast<std::size_t>(nodes.nodes[i].contact)] <= rounding_of_forces * largest)
      of_node(i).setZero();
  return forces;
}

}  // namespace

ContactResults contact_results(const feti::DualProblem& problem, const Vector& lambda, const Eigen::VectorXd& nu,
                               std::span<const double> slip_bounds, const std::vector<Eigen::VectorXd>& displacement,
                               std::span<const contact::Pair> pairs, double largest_force)
{
  const auto& comm = problem.communicator();
  const Eigen::VectorXd forces = forces_of_rows(problem, lambda, pairs.size(), largest_force);
  const Eigen::VectorXd jumps = problem.jumps(displacement) - problem.given_way(lambda);
  const auto& contacts = problem.constraints().contacts;
  const auto bound = contact_bounds(problem, nu);
  std::vector<double> largest(pairs.size(), 0.0);  // pressure of each contact
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    auto& pressure = largest[static_cast<std::size_t>(contacts.nodes[i].contact)];
    pressure = std::max(pressure, forces[problem.node_rows()[i].normal] / contacts.nodes[i].area);
  }
  for (auto& pressure : largest) pressure = comm.max(pressure);
  ContactResults results;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& point = contacts.nodes[i];
    const auto& rows = problem.node_rows()[i];
    std::vector<double> multipliers, row_jumps;
    for (Local r = rows.normal; r <= rows.normal + rows.tangents; ++r) {
      multipliers.push_back(forces[r]);
      row_jumps.push_back(jumps[r]);
      // Of the tangential rows, what moving supports and pretension sections contribute stands in the bound, beside the slip of
      // the steps before.
      const auto row = point.row + static_cast<std::size_t>(r - rows.normal);
      if (r > rows.normal) row_jumps.back() -= bound[row] - contacts.slipped_before(row);
    }
    const double slip_bound = rows.disc < 0 ? 0.0 : slip_bounds[static_cast<std::size_t>(rows.disc)];
    const auto& state =
        results.states.emplace_back(contact::state_of(point, contacts.bonded[i], multipliers, row_jumps, bound[point.row],
                                                      slip_bound, nothing * largest[static_cast<std::size_t>(point.contact)]));
    if (contacts.bonded[i]) continue;
    results.penetration = std::max(results.penetration, -state.gap * std::min(point.weight, 1.0));
    results.work_of_gaps += std::abs(state.gap * state.force);
  }
  results.penetration = comm.max(results.penetration);
  results.work_of_gaps = comm.sum(results.work_of_gaps);
  results.shown = contact::with_images(results.states, contacts.nodes);
  results.resultants = contact::resultants(results.shown, pairs.size(), comm);
  results.surfaces = contact::surface_states(results.shown, pairs, comm, contacts.without_rows);
  for (std::size_t c = 0; c < pairs.size(); ++c) results.resultants[c].area = results.surfaces[c].area;
  results.tensions = largest_tensions(results.states, pairs.size(), comm);
  return results;
}

}  // namespace mortise::post
