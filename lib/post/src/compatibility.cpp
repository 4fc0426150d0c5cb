#include "post/compatibility.hpp"

#include <algorithm>

#include "contact_bounds.hpp"
#include "post/results.hpp"

namespace mortise::post {

namespace {

// The largest distance of a copy of a node from the mean of its copies, on this rank. Collective.
double largest_tear(const partition::Decomposition& decomposition, const partition::Interface& interface,
                    const std::vector<Eigen::VectorXd>& u, int dimension, const Communicator& comm)
{
  std::vector<Eigen::MatrixXd> sums;
  for (const auto& values : u) {
    sums.emplace_back(values.size() / dimension, dimension);
    for (Eigen::Index n = 0; n < sums.back().rows(); ++n) sums.back().row(n) = values.segment(dimension * n, dimension);
  }
  sum_over_copies(decomposition, interface, sums, comm);
  double largest = 0;
  for (std::size_t s = 0; s < u.size(); ++s)
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      const Local node = interface.nodes[s][i];
      const Eigen::VectorXd mean = sums[s].row(node) / static_cast<double>(interface.copies[s][i].size());
      largest = std::max(largest, (u[s].segment(dimension * node, dimension) - mean).norm());
    }
  return largest;
}

// The largest overlap at a contact node of this rank. Collective.
double largest_overlap(const feti::DualProblem& problem, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const Eigen::VectorXd jumps = problem.jumps(u);
  const auto& contacts = problem.constraints().contacts;
  const auto bound = contact_bounds(problem, nu);
  double largest = 0;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& node = contacts.nodes[i];
    if (contacts.bonded[i]) continue;
    largest = std::max(largest, (jumps[problem.node_rows()[i].normal] - bound[node.row]) / std::max(node.weight, 1.0));
  }
  return largest;
}

}  // namespace

double incompatibility(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                       const partition::Interface& interface, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu)
{
  const auto& comm = problem.communicator();
  const double tear = largest_tear(decomposition, interface, u, problem.dimension(), comm);
  const double off = comm.max(std::max(tear, largest_overlap(problem, u, nu)));
  const double size = largest_displacement(u, problem.dimension(), comm);
  return size > 0 ? off / size : off;
}

}  // namespace mortise::post
