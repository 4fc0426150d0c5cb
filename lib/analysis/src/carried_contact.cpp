#include "analysis/carried_contact.hpp"

#include <vector>

#include "same_nodes.hpp"

namespace mortise::analysis {

CarriedContact::CarriedContact(const feti::DualProblem& problem, const qp::Solution& solution)
{
  const Eigen::VectorXd forces = problem.forces(solution.x), gaps = problem.gaps(solution.gradient, solution.nu);
  const auto& contacts = problem.constraints().contacts;
  for (const auto& [key, i] : index(contacts)) {
    const Local row = problem.node_rows()[i].normal;
    const auto& tangents = contacts.nodes[i].tangents;
    const auto values_of = [&](const Eigen::VectorXd& all) {
      Values values{all[row]};
      for (std::size_t t = 0; t < tangents.size(); ++t) values.tangential += all[row + 1 + static_cast<Local>(t)] * tangents[t];
      return values;
    };
    nodes_[key] = {values_of(forces), values_of(gaps)};
  }
}

CarriedContact CarriedContact::of_all_ranks(const Communicator& comm) const
{
  struct Sent {
    int contact, place;
    Global node;
    std::array<double, 8> values;
  };
  std::vector<Sent> own;
  for (const auto& [key, node] : nodes_) {
    const auto &f = node.force, &g = node.gap;
    own.push_back({std::get<0>(key),
                   std::get<2>(key),
                   std::get<1>(key),
                   {f.normal, f.tangential[0], f.tangential[1], f.tangential[2], g.normal, g.tangential[0], g.tangential[1],
                    g.tangential[2]}});
  }
  CarriedContact result;
  for (const auto& [contact, place, node, v] : comm.all_gather(own))
    result.nodes_[{contact, node, place}] = {{v[0], {v[1], v[2], v[3]}}, {v[4], {v[5], v[6], v[7]}}};
  return result;
}

void CarriedContact::put(const feti::DualProblem& problem, Eigen::VectorXd& forces, Eigen::VectorXd& gaps) const
{
  const auto& contacts = problem.constraints().contacts;
  for (const auto& [key, i] : index(contacts)) {
    const auto found = nodes_.find(key);
    if (found == nodes_.end()) continue;
    const Local row = problem.node_rows()[i].normal;
    const auto& tangents = contacts.nodes[i].tangents;
    const auto take = [&](const Values& values, Eigen::VectorXd& all) {
      all[row] = values.normal;
      for (std::size_t t = 0; t < tangents.size(); ++t) all[row + 1 + static_cast<Local>(t)] = values.tangential.dot(tangents[t]);
    };
    take(found->second.force, forces);
    take(found->second.gap, gaps);
  }
}

qp::Solution CarriedContact::states_for(const feti::DualProblem& problem) const
{
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.jump().rows()->getNodeNumElements()));
  Eigen::VectorXd gaps = forces;
  put(problem, forces, gaps);
  const Eigen::VectorXd nu = Eigen::VectorXd::Zero(problem.equality().size());
  return {problem.multipliers(forces), problem.gradient(gaps, nu), nu};
}

}  // namespace mortise::analysis
