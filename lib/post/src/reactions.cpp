#include <algorithm>

#include "post/balance.hpp"

namespace mortise::post {

namespace {

// What each row of a support does to its node: visit(node, force).
template <class Visit>
void for_each_support_row(const feti::DualProblem& problem, const Eigen::VectorXd& forces, const Visit& visit)
{
  const auto first = problem.jump().ranges().dirichlet;
  const auto& constraints = problem.constraints();
  const auto& prescribed = constraints.prescribed;
  for (std::size_t i = 0; i < prescribed.size(); ++i)
    if (prescribed[i].coupling < 0)
      visit(prescribed[i].node, Point(-forces[first + static_cast<Local>(i)] * Point::Unit(prescribed[i].component)));
  for (std::size_t i = 0; i < constraints.skew_supports.size(); ++i) {
    const auto& row = constraints.skew_supports[i];
    const double force = forces[first + static_cast<Local>(prescribed.size() + i)];
    for (const auto& share : std::span(row.shares).first(static_cast<std::size_t>(row.share_count)))
      visit(row.node, Point(-force * Point(share.part[0], share.part[1], share.part[2])));
  }
  const auto& springs = constraints.springs;
  for (std::size_t i = 0; i < springs.own.size(); ++i) {
    const auto& row = springs.rows[springs.own[i]];
    const double force = forces[problem.jump().ranges().springs + static_cast<Local>(i)];
    if (row.support >= 0)
      visit(row.entries.front().node, Point(-force * Point(row.direction[0], row.direction[1], row.direction[2])));
  }
}

// Calls visit(s, n, k) where local node n of subdomain s is the k-th of `nodes`, which ascend.
template <class Visit>
void for_each_copy(const partition::Decomposition& decomposition, const std::vector<Global>& nodes, const Visit& visit)
{
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& ids = decomposition.subdomains[s].mesh.node_id;
    auto k = nodes.begin();
    for (std::size_t n = 0; n < ids.size() && k != nodes.end(); ++n) {
      while (k != nodes.end() && *k < ids[n]) ++k;
      if (k != nodes.end() && *k == ids[n]) visit(s, n, static_cast<std::size_t>(k - nodes.begin()));
    }
  }
}

std::vector<Global> sorted_once(std::vector<Global> nodes)
{
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// The nodes that supports hold by rows of this rank.
std::vector<Global> prescribed_nodes(const feti::DualProblem& problem)
{
  std::vector<Global> nodes;
  for (const auto& row : problem.constraints().prescribed)
    if (row.coupling < 0) nodes.push_back(row.node);
  for (const auto& row : problem.constraints().skew_supports) nodes.push_back(row.node);
  const auto& springs = problem.constraints().springs;
  for (const std::size_t i : springs.own)
    if (springs.rows[i].support >= 0) nodes.push_back(springs.rows[i].entries.front().node);
  return sorted_once(std::move(nodes));
}

std::size_t place_of(const std::vector<Global>& nodes, Global node)
{
  return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
}

}  // namespace

std::vector<Eigen::MatrixXd> holding_forces(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                                            const partition::Interface& interface, const Vector& lambda)
{
  const auto nodes = prescribed_nodes(problem);
  std::vector<Point> force(nodes.size(), Point::Zero());
  for_each_support_row(problem, problem.forces(lambda),
                       [&](Global node, const Point& own) { force[place_of(nodes, node)] += own; });
  std::vector<Eigen::MatrixXd> result;
  for (const auto& subdomain : decomposition.subdomains)
    result.push_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(subdomain.mesh.node_count()), 3));
  std::vector<bool> given(nodes.size(), false);  // to one copy
  for_each_copy(decomposition, nodes, [&](std::size_t s, std::size_t n, std::size_t k) {
    if (!given[k]) result[s].row(static_cast<Eigen::Index>(n)) = force[k].transpose();
    given[k] = true;
  });
  partition::sum_over_copies(decomposition, interface, result, problem.communicator());
  return result;
}

}  // namespace mortise::post
