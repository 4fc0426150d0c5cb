// Subdomains in pieces hold what they held: the same cells and facets, each once, whatever the number of ranks.
#include "partition/smaller_subdomains.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "testing/cut.hpp"

namespace mortise::partition {
namespace {

Decomposition block_of(const std::string& element, int subdomains, const Communicator& comm)
{
  mesh::Options mesh;
  mesh::BlockOptions block;
  block.size = {8, 1, 1};
  block.cells = {24, 3, 3};
  block.element = element;
  mesh.blocks["beam"] = mesh.blocks["other"] = block;
  mesh.blocks["other"].origin = {0, 0, 1};
  mesh.blocks["other"].cells = {2, 1, 1};
  Options options;
  options.subdomains = subdomains;
  return cut_of(mesh, options, comm);
}

// Of each cell its subdomain and how many facets it has, over all ranks.
std::map<Global, std::vector<Global>> cells_of(const Decomposition& d, const Communicator& comm)
{
  std::vector<Global> own;
  for (const auto& subdomain : d.subdomains) {
    std::vector<Global> facets(subdomain.mesh.cells.size(), 0);
    for (const Local parent : subdomain.mesh.facets.parent) ++facets[static_cast<std::size_t>(parent)];
    for (std::size_t c = 0; c < facets.size(); ++c)
      own.insert(own.end(), {subdomain.mesh.cell_id[c], subdomain.id, subdomain.body, facets[c]});
  }
  const auto all = comm.all_gather(own);
  std::map<Global, std::vector<Global>> result;
  for (std::size_t i = 0; i < all.size(); i += 4)
    EXPECT_TRUE(result.emplace(all[i], std::vector<Global>{all[i + 1], all[i + 2], all[i + 3]}).second);
  return result;
}

TEST(SmallerSubdomains, HoldTheSameCellsAndFacets)
{
  const Communicator comm;
  for (const char* element : {"hex8", "tet4", "prism6", "hex27"})
    for (const int subdomains : {2, 5}) {
      const auto before = block_of(element, subdomains, comm);
      const auto after = smaller_subdomains(before, 150, comm);
      const auto cells_before = cells_of(before, comm), cells_after = cells_of(after, comm);
      EXPECT_GT(after.subdomain_count(), before.subdomain_count() + 3);
      EXPECT_EQ(after.cluster_count(), after.subdomain_count());
      ASSERT_EQ(cells_before.size(), cells_after.size());
      std::map<Global, std::set<Global>> within;  // of each piece the subdomain that it was cut from
      for (const auto& [cell, now] : cells_after) {
        EXPECT_EQ(now[1], cells_before.at(cell)[1]);
        EXPECT_EQ(now[2], cells_before.at(cell)[2]);
        within[now[0]].insert(cells_before.at(cell)[0]);
      }
      EXPECT_EQ(static_cast<Global>(within.size()), after.subdomain_count());
      for (const auto& [piece, from] : within) EXPECT_EQ(from.size(), 1U);
      Global next = after.first[static_cast<std::size_t>(comm.rank())];
      for (const auto& subdomain : after.subdomains) {
        EXPECT_EQ(subdomain.id, next++);
        EXPECT_LT(3 * subdomain.mesh.node_count(), 2 * 150U);
      }
      EXPECT_EQ(next, after.first[static_cast<std::size_t>(comm.rank()) + 1]);
    }
}

}  // namespace
}  // namespace mortise::partition
