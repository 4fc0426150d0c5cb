#include "post/compatibility.hpp"

#include <algorithm>
#include <cmath>

#include "constraint/coupling.hpp"
#include "contact_bounds.hpp"
#include "post/results.hpp"

namespace mortise::post {

namespace {

// Loads of a body over the largest of all, and displacements over the largest of all, below which they are none.
constexpr double loaded_part = 1e-7, moved_part = 1e-7;

// Of each body the largest distance of a copy of a node from the mean of its copies, and the largest displacement. Collective.
struct Tears {
  std::vector<double> tear, size;
};
Tears tears(const partition::Decomposition& decomposition, const partition::Interface& interface,
            const std::vector<Eigen::VectorXd>& u, int dimension, const Communicator& comm)
{
  std::vector<Eigen::MatrixXd> sums;
  for (const auto& values : u) {
    sums.emplace_back(values.size() / dimension, dimension);
    for (Eigen::Index n = 0; n < sums.back().rows(); ++n) sums.back().row(n) = values.segment(dimension * n, dimension);
  }
  sum_over_copies(decomposition, interface, sums, comm);
  const auto bodies = decomposition.catalogue.bodies.size();
  std::vector<double> largest(2 * bodies, 0.0);
  for (std::size_t s = 0; s < u.size(); ++s) {
    const auto body = static_cast<std::size_t>(decomposition.subdomains[s].body);
    for (Eigen::Index i = 0; i < u[s].size(); i += dimension)
      largest[bodies + body] = std::max(largest[bodies + body], u[s].segment(i, dimension).norm());
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      const Local node = interface.nodes[s][i];
      const Eigen::VectorXd mean = sums[s].row(node) / static_cast<double>(interface.copies[s][i].size());
      largest[body] = std::max(largest[body], (u[s].segment(dimension * node, dimension) - mean).norm());
    }
  }
  for (auto& value : largest) value = comm.max(value);
  const auto middle = largest.begin() + static_cast<std::ptrdiff_t>(bodies);
  return {{largest.begin(), middle}, {middle, largest.end()}};
}

// At the contact nodes of this rank: the largest overlap, and the largest distance across what is bonded. Collective.
struct Openings {
  double overlap = 0, bonded = 0;
};
Openings openings(const feti::DualProblem& problem, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const Eigen::VectorXd jumps = problem.jumps(u);
  const auto& contacts = problem.constraints().contacts;
  const auto bound = contact_bounds(problem, nu);
  Openings largest;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& node = contacts.nodes[i];
    if (!node.parts.empty()) continue;  // these give way
    const auto& rows = problem.node_rows()[i];
    const double weight = std::max(node.weight, 1.0);
    const auto opening = [&](int k) { return (jumps[rows.normal + k] - bound[node.row + static_cast<std::size_t>(k)]) / weight; };
    if (!contacts.bonded[i])
      largest.overlap = std::max(largest.overlap, opening(0));
    else
      for (int k = 0; k <= rows.tangents; ++k) largest.bonded = std::max(largest.bonded, std::abs(opening(k)));
  }
  return largest;
}

// The value of each row of Constraints::prescribed of this rank: what supports prescribe, and what the motions of rigid couplings
// make of it.
std::vector<double> places_of_held_nodes(const feti::DualProblem& problem, const Eigen::VectorXd& nu)
{
  const auto& constraints = problem.constraints();
  std::vector<double> places;
  for (const auto& held : constraints.prescribed) places.push_back(held.value);
  Eigen::Index next = problem.first_coupling_motion();
  for (const auto& motion : constraint::unknown_motions(constraints, problem.dimension())) {
    for (const auto& [row, part] : motion.rows) places[row] += part * nu[next];
    ++next;
  }
  return places;
}

}  // namespace

double distance_from_supports(const feti::DualProblem& problem, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const Eigen::VectorXd jumps = problem.jumps(u);
  const auto& constraints = problem.constraints();
  auto row = problem.jump().ranges().dirichlet;
  double largest = 0;
  for (const double place : places_of_held_nodes(problem, nu)) largest = std::max(largest, std::abs(jumps[row++] - place));
  for (const auto& held : constraints.skew_supports) largest = std::max(largest, std::abs(jumps[row++] - held.value));
  return problem.communicator().max(largest);
}

double distance_between_parts(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                              const partition::Interface& interface, const std::vector<Eigen::VectorXd>& u,
                              const Eigen::VectorXd& nu)
{
  const auto& comm = problem.communicator();
  const auto tear = tears(decomposition, interface, u, problem.dimension(), comm).tear;
  return std::max(comm.max(openings(problem, u, nu).bonded), *std::max_element(tear.begin(), tear.end()));
}

double incompatibility(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                       const partition::Interface& interface, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const auto& comm = problem.communicator();
  const auto [tear, size] = tears(decomposition, interface, u, problem.dimension(), comm);
  const auto loads = problem.loads_of_bodies();
  const double largest = *std::max_element(size.begin(), size.end()), load = *std::max_element(loads.begin(), loads.end());
  if (!(largest > 0)) return 0;
  double worst = std::max(comm.max(openings(problem, u, nu).overlap), distance_from_supports(problem, u, nu)) / largest;
  for (std::size_t b = 0; b < tear.size(); ++b) {
    const bool loaded = loads[b] > loaded_part * load;
    worst = std::max(worst, tear[b] / (loaded ? std::max(size[b], moved_part * largest) : largest));
  }
  return worst;
}

}  // namespace mortise::post
