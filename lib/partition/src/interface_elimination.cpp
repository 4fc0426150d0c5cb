#include "partition/interface_elimination.hpp"

#include <metis.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "base/error.hpp"

namespace mortise::partition {

namespace {

// Nodes that the same subdomains share.
struct Group {
  std::vector<Global> subdomains;  // ascending
  double nodes = 0;
};

// Those of all ranks. Collective.
std::vector<Group> groups(const Decomposition& decomposition, const Interface& interface, const Communicator& comm)
{
  std::map<std::vector<Global>, Global> own;
  std::vector<Global> sharing;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      sharing.clear();
      for (const auto& copy : interface.copies[s][i]) sharing.push_back(copy.subdomain);
      if (sharing.front() == decomposition.subdomains[s].id) ++own[sharing];
    }
  std::vector<Global> packed;
  for (const auto& [subdomains, nodes] : own) {
    packed.push_back(nodes);
    packed.push_back(static_cast<Global>(subdomains.size()));
    packed.insert(packed.end(), subdomains.begin(), subdomains.end());
  }
  packed = comm.all_gather(packed);
  std::vector<Group> all;
  for (auto at = packed.begin(); at != packed.end();) {
    const auto nodes = static_cast<double>(*at);
    const auto first = at + 2;
    at = first + *(at + 1);
    all.push_back({{first, at}, nodes});
  }
  return all;
}

// The groups that each subdomain shares in; the first is `first`.
std::vector<std::vector<int>> cliques(std::span<const Group> groups, Global first, Global end)
{
  std::vector<std::vector<int>> result(static_cast<std::size_t>(end - first));
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const Global s : groups[g].subdomains) result[static_cast<std::size_t>(s - first)].push_back(static_cast<int>(g));
  return result;
}

// position[g]: when group g is eliminated.
std::vector<int> elimination_order(std::span<const Group> groups, std::span<const std::vector<int>> cliques)
{
  std::vector<std::set<int>> adjacent(groups.size());
  for (const auto& clique : cliques)
    for (const int g : clique) adjacent[static_cast<std::size_t>(g)].insert(clique.begin(), clique.end());
  std::vector<idx_t> offset{0}, neighbours, weight;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::copy_if(adjacent[g].begin(), adjacent[g].end(), std::back_inserter(neighbours),
                 [&](int other) { return other != static_cast<int>(g); });
    offset.push_back(static_cast<idx_t>(neighbours.size()));
    weight.push_back(static_cast<idx_t>(groups[g].nodes));
  }
  auto vertices = static_cast<idx_t>(groups.size());
  std::vector<idx_t> order(groups.size()), position(groups.size());
  std::iota(position.begin(), position.end(), idx_t{0});
  if (vertices > 1 && METIS_NodeND(&vertices, offset.data(), neighbours.data(), weight.data(), nullptr, order.data(),
                                   position.data()) != METIS_OK)
    throw Error(ExitStatus::machine, "METIS could not order the interface of a body");
  return {position.begin(), position.end()};
}

// Every group joins the cliques that hold it to one of those that are left.
FactorSize eliminate(std::span<const Group> groups, std::span<const std::vector<int>> cliques, int unknowns_a_node)
{
  const auto position = elimination_order(groups, cliques);
  std::vector<double> width(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
    width[static_cast<std::size_t>(position[g])] = unknowns_a_node * groups[g].nodes;
  std::vector<std::vector<std::vector<int>>> beginning_at(groups.size());  // cliques, as positions, ascending
  const auto file = [&](std::vector<int> clique) {
    if (!clique.empty()) beginning_at[static_cast<std::size_t>(clique.front())].push_back(std::move(clique));
  };
  for (const auto& clique : cliques) {
    std::vector<int> places;
    for (const int g : clique) places.push_back(position[static_cast<std::size_t>(g)]);
    std::sort(places.begin(), places.end());
    file(std::move(places));
  }
  FactorSize size;
  for (std::size_t p = 0; p < groups.size(); ++p) {
    std::vector<int> left;
    for (const auto& clique : beginning_at[p]) left.insert(left.end(), clique.begin() + 1, clique.end());
    beginning_at[p].clear();
    std::sort(left.begin(), left.end());
    left.erase(std::unique(left.begin(), left.end()), left.end());
    double below = 0;
    for (const int q : left) below += width[static_cast<std::size_t>(q)];
    const double w = width[p];
    size.entries += w * (w + 1) / 2 + w * below;
    size.operations += w * below * below + w * (w + 1) * below + w * (w + 1) * (2 * w + 1) / 6;
    file(std::move(left));
  }
  return size;
}

}  // namespace

std::vector<FactorSize> interface_elimination(const Decomposition& decomposition, const Interface& interface,
                                              const Communicator& comm)
{
  auto all = groups(decomposition, interface, comm);
  std::sort(all.begin(), all.end(), [](const Group& a, const Group& b) { return a.subdomains < b.subdomains; });
  std::vector<double> subdomains(decomposition.catalogue.bodies.size(), 0.0);
  for (const auto& subdomain : decomposition.subdomains) subdomains[static_cast<std::size_t>(subdomain.body)] += 1;
  comm.sum_in_place(subdomains);
  std::vector<FactorSize> result;
  Global first = 0;
  auto begin = all.begin();
  for (const double of_body : subdomains) {
    const Global end = first + static_cast<Global>(of_body);
    const auto last = std::find_if(begin, all.end(), [&](const Group& group) { return group.subdomains.front() >= end; });
    const std::span<const Group> own(begin, last);
    result.push_back(eliminate(own, cliques(own, first, end), decomposition.catalogue.dimension));
    first = end, begin = last;
  }
  return result;
}

}  // namespace mortise::partition
