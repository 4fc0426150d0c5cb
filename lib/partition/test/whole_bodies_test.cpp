// Bodies taken whole are those that were cut: the same nodes, cells and facets, each once.
#include "partition/whole_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "testing/cut.hpp"

namespace mortise::partition {
namespace {

mesh::Options with_instances(const std::string& element)
{
  auto options = two_blocks(element, {6, 3, 4}, {4, 2, 3});
  mesh::InstanceOptions row;
  row.count = 4;
  row.rotate = mesh::RotationOptions{{0, 0, 1}, 90.0, {-3, 2, 1}};
  options.instances["upper"] = mesh::motions({row});
  return options;
}

// Whatever a mesh says, under numbers that no cut changes: of each cell its body and the points of its nodes, of each facet its
// boundary, its nodes and the cell it belongs to. The same on every rank.
struct Content {
  std::map<Global, std::vector<double>> nodes, cells;
  std::vector<std::vector<double>> facets;
  std::size_t copies = 0;  // of cells and nodes that stand there twice

  Content(const Decomposition& d, const Communicator& comm)
  {
    std::vector<double> node, cell, facet;  // length, then so many numbers
    const auto add = [](const std::vector<double>& record, std::vector<double>& to) {
      to.push_back(static_cast<double>(record.size()));
      to.insert(to.end(), record.begin(), record.end());
    };
    for (const auto& subdomain : d.subdomains) {
      const auto& mesh = subdomain.mesh;
      EXPECT_TRUE(std::is_sorted(mesh.node_id.begin(), mesh.node_id.end()));
      const auto id = [&](Local n) { return static_cast<double>(mesh.node_id[static_cast<std::size_t>(n)]); };
      for (std::size_t n = 0; n < mesh.node_count(); ++n)
        add({id(static_cast<Local>(n)), mesh.points[n][0], mesh.points[n][1], mesh.points[n][2]}, node);
      for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        std::vector<double> record{static_cast<double>(mesh.cell_id[c]), static_cast<double>(mesh.cell_body[c]),
                                   static_cast<double>(mesh.cells.type[c])};
        EXPECT_EQ(mesh.cell_body[c], subdomain.body);
        if (!mesh.cell_volume.empty()) record.push_back(mesh.cell_volume[c]);
        for (const Local n : mesh.cells[c]) record.push_back(id(n));
        add(record, cell);
      }
      for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
        const auto parent = mesh.facets.parent[f];
        std::vector<double> record{static_cast<double>(mesh.cell_id[static_cast<std::size_t>(parent)]),
                                   static_cast<double>(mesh.facets.boundary[f])};
        for (const Local n : mesh.facets.cells[f]) {
          record.push_back(id(n));
          const auto of_parent = mesh.cells[static_cast<std::size_t>(parent)];
          EXPECT_NE(std::find(of_parent.begin(), of_parent.end(), n), of_parent.end());
        }
        add(record, facet);
      }
    }
    const auto each = [&](const std::vector<double>& own, const auto& take) {
      const auto all = comm.all_gather(own);
      for (std::size_t at = 0; at < all.size(); at += 1 + static_cast<std::size_t>(all[at]))
        take(std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                                 all.begin() + static_cast<std::ptrdiff_t>(at + 1 + static_cast<std::size_t>(all[at]))));
    };
    const auto number = [&](std::map<Global, std::vector<double>>& to) {
      return [&](const std::vector<double>& record) {
        const auto [place, is_new] = to.emplace(static_cast<Global>(record[0]), record);
        EXPECT_EQ(place->second, record);
        copies += is_new ? 0 : 1;
      };
    };
    each(node, number(nodes));
    each(cell, number(cells));
    each(facet, [&](const std::vector<double>& record) { facets.push_back(record); });
    std::sort(facets.begin(), facets.end());
  }
};

TEST(WholeBodies, AreWhatWasCut)
{
  const Communicator comm;
  for (const char* element : {"hex8", "tet4", "prism6", "hex27"})
    for (const bool instances : {false, true})
      for (const int per_cluster : {1, 3}) {
        Options options;
        options.unknowns_per_subdomain = 60;
        options.subdomains_per_cluster = per_cluster;
        const auto cut = cut_of(instances ? with_instances(element) : two_blocks(element, {6, 3, 4}, {4, 2, 3}), options, comm);
        const auto whole = whole_bodies(cut, comm);
        const auto bodies = static_cast<Global>(cut.catalogue.bodies.size());
        ASSERT_GT(cut.subdomain_count(), 2 * bodies);
        EXPECT_EQ(whole.subdomain_count(), bodies);
        EXPECT_FALSE(whole.clustered());
        EXPECT_EQ(whole.catalogue.node_count, cut.catalogue.node_count);
        ASSERT_EQ(whole.first.size(), static_cast<std::size_t>(comm.size()) + 1);
        Global next = whole.first[static_cast<std::size_t>(comm.rank())];
        for (const auto& subdomain : whole.subdomains) {
          EXPECT_EQ(subdomain.id, next++);
          EXPECT_EQ(subdomain.body, subdomain.id);
          EXPECT_EQ(whole.rank_of(subdomain.id), comm.rank());
        }
        EXPECT_EQ(next, whole.first[static_cast<std::size_t>(comm.rank()) + 1]);
        const Content before(cut, comm), after(whole, comm);
        EXPECT_GT(before.copies, 0U);
        EXPECT_EQ(after.copies, 0U);
        EXPECT_EQ(static_cast<Global>(after.cells.size()), cut.catalogue.cell_count);
        EXPECT_EQ(static_cast<Global>(after.nodes.size()), cut.catalogue.node_count);
        EXPECT_EQ(after.nodes, before.nodes);
        EXPECT_EQ(after.cells, before.cells);
        EXPECT_EQ(after.facets, before.facets);
      }
}

// More ranks than bodies, and a body that is whole already.
TEST(WholeBodies, OfOneBodyThatIsWholeNothingChanges)
{
  const Communicator comm;
  auto blocks = two_blocks("hex8", {6, 3, 4}, {4, 2, 3});
  blocks.blocks.erase("upper");
  Options options;
  options.subdomains = 1;
  const auto cut = cut_of(blocks, options, comm), whole = whole_bodies(cut, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(whole.subdomains.size())), 1);
  const Content before(cut, comm), after(whole, comm);
  EXPECT_EQ(after.nodes, before.nodes);
  EXPECT_EQ(after.cells, before.cells);
  EXPECT_EQ(after.facets, before.facets);
}

}  // namespace
}  // namespace mortise::partition
