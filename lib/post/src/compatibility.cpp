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

// At the contact nodes of this rank, of each group of bodies, see feti::BodyGroups: the largest overlap, and the largest distance
// across what is bonded. Collective.
struct Openings {
  std::vector<double> overlap, bonded;
};
Openings openings(const feti::DualProblem& problem, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const Eigen::VectorXd jumps = problem.jumps(u);
  const auto& contacts = problem.constraints().contacts;
  const auto& groups = problem.system().groups();
  const auto bound = contact_bounds(problem, nu);
  const std::vector<double> none(groups.of_body.size(), 0.0);
  Openings largest{none, none};
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& node = contacts.nodes[i];
    if (!node.parts.empty()) continue;  // these give way
    const auto& rows = problem.node_rows()[i];
    const double weight = std::max(node.weight, 1.0);
    const auto opening = [&](int k) { return (jumps[rows.normal + k] - bound[node.row + static_cast<std::size_t>(k)]) / weight; };
    const auto group = static_cast<std::size_t>(std::max(groups.of_row[static_cast<std::size_t>(rows.normal)], 0));
    if (!contacts.bonded[i])
      largest.overlap[group] = std::max(largest.overlap[group], opening(0));
    else
      for (int k = 0; k <= rows.tangents; ++k) largest.bonded[group] = std::max(largest.bonded[group], std::abs(opening(k)));
  }
  return largest;
}

// The value of each row of Constraints::prescribed of this rank: what supports prescribe, and what the motions of rigid couplings
// make of it.
std::vector<double> places_of_prescribed_nodes(const feti::DualProblem& problem, const Eigen::VectorXd& nu)
{
  const auto& constraints = problem.constraints();
  std::vector<double> places;
  for (const auto& dof : constraints.prescribed) places.push_back(dof.value);
  Eigen::Index next = problem.first_coupling_motion();
  for (const auto& motion : constraint::unknown_motions(constraints, problem.dimension())) {
    for (const auto& [row, part] : motion.rows) places[row] += part * nu[next];
    ++next;
  }
  return places;
}

// Of each group of bodies the largest distance of what this rank's supports hold from where they hold it. Collective.
std::vector<double> distances_from_supports(const feti::DualProblem& problem, const std::vector<Eigen::VectorXd>& u,
                                            const Eigen::VectorXd& nu)
{
  const Eigen::VectorXd jumps = problem.jumps(u);
  const auto& constraints = problem.constraints();
  const auto& groups = problem.system().groups();
  std::vector<double> largest(groups.of_body.size(), 0.0);
  auto row = problem.jump().ranges().dirichlet;
  const auto note = [&](double place) {
    auto& distance = largest[static_cast<std::size_t>(std::max(groups.of_row[static_cast<std::size_t>(row)], 0))];
    distance = std::max(distance, std::abs(jumps[row++] - place));
  };
  for (const double place : places_of_prescribed_nodes(problem, nu)) note(place);
  for (const auto& support : constraints.skew_supports) note(support.value);
  return largest;
}

}  // namespace

double distance_from_supports(const feti::DualProblem& problem, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const auto distances = distances_from_supports(problem, u, nu);
  return problem.communicator().max(*std::max_element(distances.begin(), distances.end()));
}

double distance_between_parts(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                              const partition::Interface& interface, const std::vector<Eigen::VectorXd>& u,
                              const Eigen::VectorXd& nu)
{
  const auto& comm = problem.communicator();
  const auto tear = tears(decomposition, interface, u, problem.dimension(), comm).tear;
  const auto bonded = openings(problem, u, nu).bonded;
  return std::max(comm.max(*std::max_element(bonded.begin(), bonded.end())), *std::max_element(tear.begin(), tear.end()));
}

double incompatibility(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                       const partition::Interface& interface, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const auto& comm = problem.communicator();
  const auto& groups = problem.system().groups().of_body;
  const auto [tear, size] = tears(decomposition, interface, u, problem.dimension(), comm);
  const auto loads = problem.loads_of_bodies();
  const double all = *std::max_element(size.begin(), size.end()), load = *std::max_element(loads.begin(), loads.end());
  if (!(all > 0)) return 0;
  std::vector<double> largest(groups.size(), moved_part * all);  // displacement in each group
  for (std::size_t b = 0; b < groups.size(); ++b) {
    auto& of_group = largest[static_cast<std::size_t>(groups[b])];
    of_group = std::max(of_group, size[b]);
  }
  const auto [overlap, bonded] = openings(problem, u, nu);
  const auto away = distances_from_supports(problem, u, nu);
  double worst = 0;
  for (std::size_t g = 0; g < groups.size(); ++g)
    worst = std::max(worst, std::max({overlap[g], bonded[g], away[g]}) / largest[g]);
  worst = comm.max(worst);
  for (std::size_t b = 0; b < tear.size(); ++b) {
    const bool loaded = loads[b] > loaded_part * load;
    worst =
        std::max(worst, tear[b] / (loaded ? std::max(size[b], moved_part * all) : largest[static_cast<std::size_t>(groups[b])]));
  }
  return worst;
}

}  // namespace mortise::post
