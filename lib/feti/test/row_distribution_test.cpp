// Two blocks of eight subdomains each, on top of each other: rows that stand on the ranks in turn find their subdomains.
#include "feti/row_distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "feti/jump_operator.hpp"
#include "testing/cut.hpp"

namespace mortise::feti {
namespace {

struct CutBlocks {
  Communicator comm;
  partition::Decomposition decomposition;
  std::unique_ptr<partition::NodeDirectory> directory;
  partition::Interface interface;

  CutBlocks()
  {
    mesh::Options mesh;
    mesh.blocks["lower"] = {{0, 0, 0}, {1, 1, 1}, {4, 4, 4}, "hex8"};
    mesh.blocks["upper"] = {{0, 0, 1}, {1, 1, 1}, {4, 4, 4}, "hex8"};
    partition::Options options;
    options.method = "grid";
    options.counts["lower"] = options.counts["upper"] = {2, 2, 2};
    decomposition = partition::cut_of(mesh, options, comm);
    directory = std::make_unique<partition::NodeDirectory>(partition::even_directory(decomposition, comm));
    interface = partition::find_interface(decomposition, *directory, comm);
  }

  // The nodes of a boundary in the order of their places, the same on every rank.
  std::vector<Global> nodes_of(const std::string& name) const
  {
    const auto surface = partition::side_of(decomposition, name);
    struct Node {
      double x, y, z;
      Global id;
    };
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < surface.points.size(); ++i)
      nodes.push_back({surface.points[i][0], surface.points[i][1], surface.points[i][2], surface.node_id[i]});
    nodes = comm.all_gather(nodes);
    std::sort(nodes.begin(), nodes.end(),
              [](const Node& a, const Node& b) { return std::tie(a.x, a.y, a.z, a.id) < std::tie(b.x, b.y, b.z, b.id); });
    std::vector<Global> ids;
    for (const auto& node : nodes)
      if (ids.empty() || ids.back() != node.id) ids.push_back(node.id);
    return ids;
  }

  bool mine(std::size_t i) const { return static_cast<int>(i) % comm.size() == comm.rank(); }

  std::vector<constraint::PrescribedDof> prescribed() const
  {
    std::vector<constraint::PrescribedDof> result;
    const auto nodes = nodes_of("lower.zmin");
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int c = 0; c < 2; ++c)
        if (mine(i)) result.push_back({nodes[i], c, 0.5 * c, 0});
    return result;
  }

  std::vector<constraint::SkewSupport> skew_supports() const
  {
    std::vector<constraint::SkewSupport> result;
    const auto nodes = nodes_of("upper.xmin");
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const double x : {0.6, -0.6})
        if (mine(i)) result.push_back({nodes[i], {x, 0.8, 0}, x, {}, 0});
    return result;
  }

  // Node i of the upper block on node i of the lower one, with none, one or two tangents, and prescribed entries that say whose
  // they are.
  constraint::Contacts contacts() const
  {
    constraint::Contacts contacts;
    const auto above = nodes_of("upper.zmin"), below = nodes_of("lower.zmax");
    const std::vector<Point> tangents{Point(0.6, 0.8, 0), Point(0.8, -0.6, 0)};
    for (std::size_t i = 0; i < above.size(); ++i) {
      if (!mine(i)) continue;
      const auto number = static_cast<double>(above[i]);
      contacts.nodes.push_back({static_cast<int>(i % 2),
                                above[i],
                                1 + number,
                                Point(0, 0, -1),
                                {tangents.begin(), tangents.begin() + static_cast<std::ptrdiff_t>(i % 3)},
                                contacts.rows.size(),
                                2 + number,
                                3 + number,
                                Point(number, 0, 1)});
      contacts.nodes.back().prescribed_share = 4 + number;
      contacts.bonded.push_back(i % 2 == 1);
      for (std::size_t r = 0; r <= i % 3; ++r) {
        contacts.prescribed.push_back({contacts.rows.size(), static_cast<int>(r), static_cast<int>(above[i]), number});
        contacts.rows.entries.push_back({above[i], 2, 1.0});
        contacts.rows.entries.push_back({below[i], 2, -1.0});
        if (r > 0) contacts.rows.entries.push_back({below[i], 0, number});
        contacts.rows.close(number + static_cast<double>(r));
      }
    }
    return contacts;
  }
};

TEST(RowDistribution, TheOwnerOfARowHoldsACopy)
{
  const CutBlocks blocks;
  const auto& [comm, decomposition, directory] = std::tie(blocks.comm, blocks.decomposition, *blocks.directory);
  const auto prescribed = distribute_rows(blocks.prescribed(), decomposition, directory, comm);
  const auto skew_supports = distribute_rows(blocks.skew_supports(), decomposition, directory, comm);
  const auto contacts = distribute_rows(blocks.contacts(), decomposition, directory, comm);
  const JumpOperator jump(decomposition, directory, blocks.interface, prescribed, skew_supports, contacts, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(prescribed.size())), 2 * 25);
  EXPECT_EQ(comm.sum(static_cast<long long>(skew_supports.size())), 2 * 25);
  for (const Global row : jump.rows()->getNodeElementList()) EXPECT_TRUE(jump.touched_rows()->isNodeGlobalElement(row));
}

TEST(RowDistribution, RowsOfANodeStandWithItsLowestSubdomain)
{
  const CutBlocks blocks;
  const auto& comm = blocks.comm;
  std::vector<Global> nodes;
  for (const auto& h : distribute_rows(blocks.prescribed(), blocks.decomposition, *blocks.directory, comm))
    nodes.push_back(h.node);
  for (const auto& i : distribute_rows(blocks.skew_supports(), blocks.decomposition, *blocks.directory, comm))
    nodes.push_back(i.node);
  for (const auto& p : distribute_rows(blocks.contacts(), blocks.decomposition, *blocks.directory, comm).nodes)
    nodes.push_back(p.node);
  const auto copies = blocks.directory->find(nodes, comm);
  for (std::size_t i = 0; i < nodes.size(); ++i) EXPECT_EQ(blocks.decomposition.rank_of(copies[i][0].subdomain), comm.rank());
}

TEST(RowDistribution, SupportsAreAscendingAndKeepTheOrderAtANode)
{
  const CutBlocks blocks;
  const auto prescribed = distribute_rows(blocks.prescribed(), blocks.decomposition, *blocks.directory, blocks.comm);
  EXPECT_TRUE(std::is_sorted(prescribed.begin(), prescribed.end(), [](const auto& a, const auto& b) {
    return std::tie(a.node, a.component) < std::tie(b.node, b.component);
  }));
  for (const auto& h : prescribed) EXPECT_EQ(h.value, 0.5 * h.component);
  const auto skew_supports = distribute_rows(blocks.skew_supports(), blocks.decomposition, *blocks.directory, blocks.comm);
  ASSERT_EQ(skew_supports.size() % 2, 0U);
  for (std::size_t i = 0; i < skew_supports.size(); i += 2) {
    EXPECT_EQ(skew_supports[i].node, skew_supports[i + 1].node);
    EXPECT_EQ(skew_supports[i].value, 0.6);
    EXPECT_EQ(skew_supports[i + 1].value, -0.6);
  }
}

TEST(RowDistribution, ContactPointsKeepTheirRows)
{
  const CutBlocks blocks;
  const auto contacts = distribute_rows(blocks.contacts(), blocks.decomposition, *blocks.directory, blocks.comm);
  EXPECT_EQ(blocks.comm.sum(static_cast<long long>(contacts.nodes.size())), 25);
  EXPECT_EQ(contacts.bonded.size(), contacts.nodes.size());
  EXPECT_EQ(contacts.prescribed.size(), contacts.rows.size());
  std::size_t rows = 0;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& point = contacts.nodes[i];
    const auto number = static_cast<double>(point.node);
    EXPECT_EQ(point.row, rows);
    EXPECT_EQ(contacts.bonded[i], point.contact == 1);
    EXPECT_EQ(point.area, 1 + number);
    EXPECT_EQ(point.weight, 2 + number);
    EXPECT_EQ(point.gap, 3 + number);
    EXPECT_EQ(point.prescribed_share, 4 + number);
    EXPECT_EQ(point.normal, Point(0, 0, -1));
    EXPECT_EQ(point.at, Point(number, 0, 1));
    for (std::size_t r = 0; r <= point.tangents.size(); ++r, ++rows) {
      const auto row = contacts.rows[rows];
      EXPECT_EQ(contacts.rows.bound[rows], number + static_cast<double>(r));
      ASSERT_EQ(row.size(), r > 0 ? 3U : 2U);
      EXPECT_EQ(row[0].node, point.node);
      EXPECT_EQ(row[1].coefficient, -1.0);
      if (r > 0) {
        EXPECT_EQ(row[2].coefficient, number);
      }
      EXPECT_EQ(contacts.prescribed[rows].row, rows);
      EXPECT_EQ(contacts.prescribed[rows].component, static_cast<int>(r));
      EXPECT_EQ(contacts.prescribed[rows].support, static_cast<int>(point.node));
    }
    const std::vector<Point> tangents{Point(0.6, 0.8, 0), Point(0.8, -0.6, 0)};
    for (std::size_t t = 0; t < point.tangents.size(); ++t) EXPECT_EQ(point.tangents[t], tangents[t]);
  }
  EXPECT_EQ(rows, contacts.rows.size());
}

}  // namespace
}  // namespace mortise::feti
