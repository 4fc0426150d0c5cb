#include "analysis/carried_contact.hpp"

#include <array>
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

namespace {

// A contact node on its way to another rank.
struct Sent {
  int contact, place;
  Global node;
  std::array<double, 8> values;
};

std::size_t rank_of(Global node, const Communicator& comm)
{
  return static_cast<std::size_t>(node) % static_cast<std::size_t>(comm.size());
}

}  // namespace

// Sends nodes, as lists of those for each rank, and returns those that have come.
CarriedContact CarriedContact::exchange(const std::vector<std::vector<NodeKey>>& to, const Communicator& comm) const
{
  std::vector<std::vector<Sent>> send(to.size());
  for (std::size_t rank = 0; rank < to.size(); ++rank)
    for (const auto& key : to[rank]) {
      const auto& [contact, node, place] = key;
      const auto& [f, g] = nodes_.at(key);
      send[rank].push_back({contact,
                            place,
                            node,
                            {f.normal, f.tangential[0], f.tangential[1], f.tangential[2], g.normal, g.tangential[0],
                             g.tangential[1], g.tangential[2]}});
    }
  CarriedContact result;
  for (const auto& part : comm.exchange(send))
    for (const auto& [contact, place, node, v] : part)
      result.nodes_[{contact, node, place}] = {{v[0], {v[1], v[2], v[3]}}, {v[4], {v[5], v[6], v[7]}}};
  return result;
}

CarriedContact CarriedContact::spread(const Communicator& comm) const
{
  std::vector<std::vector<NodeKey>> to(static_cast<std::size_t>(comm.size()));
  for (const auto& [key, node] : nodes_) to[rank_of(std::get<1>(key), comm)].push_back(key);
  return exchange(to, comm);
}

CarriedContact CarriedContact::at(const constraint::Contacts& contacts, const Communicator& comm) const
{
  struct Asked {
    int contact, place;
    Global node;
  };
  std::vector<std::vector<Asked>> ask(static_cast<std::size_t>(comm.size()));
  for (const auto& [key, i] : index(contacts)) {
    const auto& [contact, node, place] = key;
    ask[rank_of(node, comm)].push_back({contact, place, node});
  }
  std::vector<std::vector<NodeKey>> to;
  for (const auto& asked : comm.exchange(ask)) {
    auto& keys = to.emplace_back();
    for (const auto& [contact, place, node] : asked)
      if (nodes_.contains({contact, node, place})) keys.emplace_back(contact, node, place);
  }
  return exchange(to, comm);
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

qp::Solution CarriedContact::states_for(const feti::DualProblem& problem, const Communicator& comm) const
{
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.jump().rows()->getNodeNumElements()));
  Eigen::VectorXd gaps = forces;
  at(problem.constraints().contacts, comm).put(problem, forces, gaps);
  const Eigen::VectorXd nu = Eigen::VectorXd::Zero(problem.equality().size());
  return {problem.multipliers(forces), problem.gradient(gaps, nu), nu};
}

}  // namespace mortise::analysis
