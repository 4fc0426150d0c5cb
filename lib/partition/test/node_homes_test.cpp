// Where what is known of a node meets, and its copies, as all ranks together see them.
#include "partition/node_homes.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "testing/cut.hpp"

namespace mortise::partition {
namespace {

Options six_subdomains()
{
  Options options;
  options.method = "grid";
  options.counts = {{"lower", {3, 1, 1}}, {"upper", {3, 1, 1}}};
  return options;
}

class Cut {
 public:
  Cut()
      : decomposition(cut_of(two_blocks("hex8", {6, 3, 3}, {6, 3, 3}), six_subdomains(), comm)),
        directory(even_directory(decomposition, comm)),
        interface(find_interface(decomposition, directory, comm))
  {
    struct OnRank {
      Global node, subdomain;
      Local local;
      int rank;
    };
    std::vector<OnRank> own;
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
      for (const Local n : directory.surface(s))
        own.push_back({decomposition.subdomains[s].mesh.node_id[static_cast<std::size_t>(n)], decomposition.subdomains[s].id, n,
                       comm.rank()});
    for (const auto& at : comm.all_gather(own)) {
      ranks[at.node].insert(at.rank);
      copies[at.node][at.subdomain] = at.local;
    }
  }

  Communicator comm;
  Decomposition decomposition;
  NodeDirectory directory;
  Interface interface;
  std::map<Global, std::set<int>> ranks;             // that have a node
  std::map<Global, std::map<Global, Local>> copies;  // of a node, by subdomain
};

TEST(NodeHomes, AreTheFirstRankThatHasTheNode)
{
  const Cut cut;
  std::vector<Global> all;  // of all ranks
  for (const auto& [node, ranks] : cut.ranks) all.insert(all.end(), {node, node});
  const NodeHomes homes(cut.decomposition, cut.interface, cut.directory, all, cut.comm);
  ASSERT_GT(cut.ranks.size(), 0u);
  for (const auto& [node, ranks] : cut.ranks) EXPECT_EQ(homes(node), static_cast<std::size_t>(*ranks.begin()));
}

TEST(NodeHomes, KnowTheCopiesOfOwnNodes)
{
  const Cut cut;
  const NodeHomes homes(cut.decomposition, cut.interface, cut.directory, {}, cut.comm);
  std::size_t shared = 0;
  for (const auto& [node, ranks] : cut.ranks) {
    const auto found = homes.copies(node);
    if (!ranks.contains(cut.comm.rank())) {
      EXPECT_TRUE(found.empty());
      continue;
    }
    EXPECT_EQ(homes(node), static_cast<std::size_t>(*ranks.begin()));
    std::map<Global, Local> seen;
    for (const auto& copy : found) seen[copy.subdomain] = copy.node;
    EXPECT_EQ(seen, cut.copies.at(node));
    EXPECT_EQ(found.size(), seen.size());
    shared += found.size() > 1;
  }
  EXPECT_TRUE(cut.comm.any(shared > 0));
}

}  // namespace
}  // namespace mortise::partition
