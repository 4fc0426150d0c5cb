#include "partition/decompose.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "mesh/topology.hpp"
#include "partition/congruence.hpp"
#include "partition/node_directory.hpp"
#include "testing/cut.hpp"

namespace mortise::partition {
namespace {

// The cells of all subdomains, in order, on every rank: does not depend on the number of ranks.
std::vector<Global> fingerprint(const Decomposition& d, const Communicator& comm)
{
  std::vector<Global> mine;
  for (const auto& s : d.subdomains) {
    mine.push_back(-1 - s.id);
    mine.insert(mine.end(), s.mesh.cell_id.begin(), s.mesh.cell_id.end());
  }
  return comm.all_gather(mine);
}

TEST(Decompose, PaperSFirstRowHasItsUnknowns)
{
  const Communicator comm;
  Options options;
  options.method = "grid";
  options.counts = {{"lower", {6, 3, 3}}, {"upper", {6, 3, 3}}};
  const auto d = cut_of(two_blocks("hex8", {60, 30, 30}, {60, 30, 30}), options, comm);
  EXPECT_EQ(d.subdomain_count(), 108);
  long long nodes = 0;
  for (const auto& s : d.subdomains) nodes += static_cast<long long>(s.mesh.node_count());
  EXPECT_EQ(3 * comm.sum(nodes), 431244);
}

TEST(Decompose, MetisPartsAreConnectedAndCoverEveryCellOnce)
{
  const Communicator comm;
  Options options;
  options.subdomains = 14;
  const auto d = cut_of(two_blocks("tet4", {8, 4, 4}, {8, 4, 4}), options, comm);
  const Communicator alone(MPI_COMM_SELF);
  const auto serial = cut_of(two_blocks("tet4", {8, 4, 4}, {8, 4, 4}), options, alone);
  EXPECT_EQ(fingerprint(d, comm), fingerprint(serial, alone));
  std::set<Global> cells;
  for (const auto& s : serial.subdomains) {
    const auto part = mesh::connected_parts(mesh::face_neighbours(s.mesh.cells), std::vector<int>(s.mesh.cells.size(), 0));
    EXPECT_EQ(*std::max_element(part.begin(), part.end()), 0) << "subdomain " << s.id;
    for (const Global c : s.mesh.cell_id) EXPECT_TRUE(cells.insert(c).second);
  }
  EXPECT_EQ(static_cast<Global>(cells.size()), serial.catalogue.cell_count);
  EXPECT_EQ(d.subdomain_count(), 14);
}

TEST(Cut, IslandsJoinANeighbour)
{
  // A small plate in many parts: METIS leaves pieces apart, which must not stay so.
  mesh::Options options;
  mesh::BlockOptions block;
  block.cells = {6, 6, 0};
  block.element = "quad4";
  options.blocks["plate"] = block;
  Options cut_options;
  const Communicator alone(MPI_COMM_SELF);
  for (int parts = 2; parts < 13; ++parts) {
    cut_options.subdomains = parts;
    for (const auto& s : cut_of(options, cut_options, alone, 2).subdomains) {
      const auto part = mesh::connected_parts(mesh::face_neighbours(s.mesh.cells), std::vector<int>(s.mesh.cells.size(), 0));
      EXPECT_EQ(*std::max_element(part.begin(), part.end()), 0);
    }
  }
}

// Every cluster lies in one body and on one rank and is connected by faces; neither they nor the cells depend on the ranks.
TEST(Clusters, AreConnectedPartsOfBodiesOnOneRank)
{
  const Communicator comm, alone(MPI_COMM_SELF);
  Options metis;
  metis.unknowns_per_subdomain = 60;
  metis.subdomains_per_cluster = 5;
  Options grid;
  grid.method = "grid";
  grid.counts = {{"lower", {8, 4, 4}}, {"upper", {5, 3, 2}}};
  grid.subdomains_per_cluster = 8;
  for (const auto& options : {metis, grid}) {
    const auto serial = cut_of(two_blocks("hex8", {8, 4, 4}, {8, 4, 4}), options, alone),
               d = cut_of(two_blocks("hex8", {8, 4, 4}, {8, 4, 4}), options, comm);
    EXPECT_EQ(fingerprint(d, comm), fingerprint(serial, alone));
    EXPECT_EQ(d.clusters, serial.clusters);
    EXPECT_TRUE(d.clustered());
    for (const Global first : d.first) EXPECT_TRUE(std::binary_search(d.clusters.begin(), d.clusters.end(), first));
    ASSERT_EQ(serial.clusters.back(), serial.subdomain_count());
    for (std::size_t c = 0; c + 1 < serial.clusters.size(); ++c) {
      ASSERT_LT(serial.clusters[c], serial.clusters[c + 1]);
      EXPECT_LE(serial.clusters[c + 1] - serial.clusters[c], 2 * options.subdomains_per_cluster);
      std::map<std::array<Local, 4>, std::vector<std::size_t>> owners;  // of each face, by numbers of nodes
      const auto first = static_cast<std::size_t>(serial.clusters[c]), end = static_cast<std::size_t>(serial.clusters[c + 1]);
      for (std::size_t s = first; s < end; ++s) {
        const auto& mesh = serial.subdomains[s].mesh;
        EXPECT_EQ(serial.subdomains[s].body, serial.subdomains[first].body);
        for (const auto& face : mesh::sorted_faces(mesh.cells)) {
          auto key = face.corners;
          for (auto& n : key) n = static_cast<Local>(mesh.node_id[static_cast<std::size_t>(n)]);
          std::sort(key.begin(), key.end());
          owners[key].push_back(s - first);
        }
      }
      std::vector<std::size_t> joined(end - first);
      std::iota(joined.begin(), joined.end(), 0);
      for (std::size_t round = first; round < end; ++round)
        for (const auto& [face, list] : owners)
          for (const auto s : list) joined[s] = joined[list.front()] = std::min(joined[s], joined[list.front()]);
      for (const auto s : joined) EXPECT_EQ(s, 0U) << "cluster " << c;
    }
  }
}

TEST(Clusters, OfAGridAreBlocksOfIt)
{
  const Communicator alone(MPI_COMM_SELF);
  const auto count = [&](std::array<int, 3> lower, int size) {
    Options options;
    options.method = "grid";
    options.counts = {{"lower", lower}, {"upper", {1, 1, 1}}};
    options.subdomains_per_cluster = size;
    const auto d = cut_of(two_blocks("hex8", {12, 12, 12}, {12, 12, 12}), options, alone);
    EXPECT_EQ(d.clusters[static_cast<std::size_t>(d.cluster_count()) - 1], d.subdomain_count() - 1);
    return d.cluster_count() - 1;
  };
  EXPECT_EQ(count({8, 4, 4}, 1), 128);
  EXPECT_EQ(count({8, 4, 4}, 8), 16);
  EXPECT_EQ(count({8, 4, 4}, 64), 2);
  EXPECT_EQ(count({9, 9, 1}, 9), 9);  // a plate: the other axes make up for the short one
  EXPECT_EQ(count({12, 1, 1}, 4), 3);
  EXPECT_EQ(count({7, 7, 7}, 1000), 1);
}

TEST(NodeDirectory, KnowsEveryCopy)
{
  const Communicator comm;
  Options options;
  options.method = "grid";
  options.counts = {{"lower", {3, 2, 2}}, {"upper", {2, 2, 1}}};
  const auto d = cut_of(two_blocks("hex8", {6, 4, 4}, {6, 4, 4}), options, comm);
  std::vector<std::vector<double>> weight;
  for (const auto& s : d.subdomains) weight.emplace_back(s.mesh.node_count(), static_cast<double>(s.id));
  const NodeDirectory directory(d, weight, comm);

  std::vector<Global> all;  // every copy of every node, gathered whole
  for (const auto& s : d.subdomains) all.insert(all.end(), s.mesh.node_id.begin(), s.mesh.node_id.end());
  std::map<Global, std::size_t> copies;
  for (const Global node : comm.all_gather(all)) ++copies[node];
  std::vector<Global> asked;
  for (const auto& [node, count] : copies) asked.push_back(node);
  const auto found = directory.find(asked, comm);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (copies[asked[i]] > 1) {
      EXPECT_EQ(found[i].size(), copies[asked[i]]);
    }
    for (const auto& copy : found[i]) EXPECT_EQ(copy.weight, static_cast<double>(copy.subdomain));
  }

  const auto interface = find_interface(d, directory, comm);
  std::vector<Eigen::MatrixXd> values;
  for (const auto& s : d.subdomains) values.push_back(Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(s.mesh.node_count()), 2));
  sum_over_copies(d, interface, values, comm);
  for (std::size_t s = 0; s < values.size(); ++s)
    for (std::size_t n = 0; n < d.subdomains[s].mesh.node_count(); ++n)
      EXPECT_EQ(values[s](static_cast<Eigen::Index>(n), 1), static_cast<double>(copies[d.subdomains[s].mesh.node_id[n]]));

  // The same in columns, without subdomain 1.
  std::vector<Eigen::MatrixXd> columns;
  for (const auto& s : d.subdomains)
    columns.push_back(Eigen::MatrixXd::Constant(2, static_cast<Eigen::Index>(s.mesh.node_count()), s.id == 1 ? 0.5 : 1.0));
  const auto column_at = [&](std::size_t s, Local n) { return d.subdomains[s].id == 1 ? no_row() : column_of(columns[s], n); };
  sum_rows(d, interface, 2, column_at, comm);
  for (std::size_t s = 0; s < columns.size(); ++s)
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      const auto all = interface.copies[s][i];
      const auto without = std::count_if(all.begin(), all.end(), [](const Copy& copy) { return copy.subdomain != 1; });
      EXPECT_EQ(columns[s](1, interface.nodes[s][i]), d.subdomains[s].id == 1 ? 0.5 : static_cast<double>(without));
    }
}

TEST(Congruence, CopiesAreFoundAndOthersAreNot)
{
  const Communicator alone(MPI_COMM_SELF);
  Options options;
  options.method = "grid";
  options.counts = {{"lower", {3, 2, 2}}, {"upper", {4, 2, 2}}};  // cells 2 x 2 x 2, and 1 or 2 x 2 x 2
  auto d = cut_of(two_blocks("hex8", {6, 4, 4}, {6, 4, 4}), options, alone);
  std::vector<int> kind(d.subdomains.size(), 0);
  const auto first = congruent(d.subdomains, kind);
  std::set<std::size_t> originals;
  for (const auto& copy : first) originals.insert(copy.original);
  EXPECT_EQ(originals.size(), 2U);  // of 12 and 16
  for (std::size_t s = 0; s < first.size(); ++s) {
    EXPECT_EQ(d.subdomains[s].mesh.cells.size(), d.subdomains[first[s].original].mesh.cells.size());
    EXPECT_FALSE(first[s].rotation);
  }
  kind[3] = 1;
  EXPECT_EQ(congruent(d.subdomains, kind)[3].original, 3U);
  d.subdomains[4].mesh.points[5][0] += 1e-7;
  EXPECT_EQ(congruent(d.subdomains, kind)[4].original, 4U);
  d.subdomains[4].mesh.points[5][0] -= 1e-7;
  EXPECT_EQ(congruent(d.subdomains, kind)[4].original, 0U);
}

// The two halves of the lower beam.
Decomposition two_halves()
{
  const Communicator alone(MPI_COMM_SELF);
  Options options;
  options.method = "grid";
  options.counts = {{"lower", {2, 1, 1}}, {"upper", {1, 1, 1}}};
  auto d = cut_of(two_blocks("hex8", {6, 4, 4}, {6, 4, 4}), options, alone);
  d.subdomains.resize(2);
  return d;
}

TEST(Congruence, RotatedCopiesAreFoundAndMirroredOnesAreNot)
{
  auto d = two_halves();
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()).matrix();
  auto& rotated = d.subdomains[1].mesh.points;
  for (auto& p : rotated) p = rotation * p + Point(5, 0, -2);
  const std::vector<int> kind(2, 0);
  const auto copies = congruent(d.subdomains, kind);
  EXPECT_EQ(copies[1].original, 0U);
  ASSERT_TRUE(copies[1].rotation);
  EXPECT_LT((*copies[1].rotation - rotation).norm(), 1e-10);
  EXPECT_EQ(congruent(d.subdomains, kind, Motions::along_y)[1].original, 1U);
  const auto rotated_alike = [&](const Subdomain&, const Subdomain&, const Eigen::Matrix3d& r) {
    return (r - rotation).norm() < 1e-9;
  };
  EXPECT_EQ(congruent(d.subdomains, kind, Motions::rigid, rotated_alike)[1].original, 0U);
  const auto unlike = [](const Subdomain&, const Subdomain&, const Eigen::Matrix3d&) { return false; };
  EXPECT_EQ(congruent(d.subdomains, kind, Motions::rigid, unlike)[1].original, 1U);
  for (auto& p : rotated) p[1] = -p[1];
  EXPECT_EQ(congruent(d.subdomains, kind)[1].original, 1U);
}

// Of two rings of one section those of one radius are copies.
TEST(Congruence, RingsAreCopiesOnlyAlongTheAxis)
{
  auto d = two_halves();
  const std::vector<int> kind(2, 0);
  EXPECT_EQ(congruent(d.subdomains, kind)[1].original, 0U);
  EXPECT_EQ(congruent(d.subdomains, kind, Motions::along_y)[1].original, 1U);  // beside it
  d.subdomains[1].mesh.points = d.subdomains[0].mesh.points;
  for (auto& p : d.subdomains[1].mesh.points) p[1] += 3;
  EXPECT_EQ(congruent(d.subdomains, kind, Motions::along_y)[1].original, 0U);
}

TEST(BoundarySurface, IsWholeOverAllRanks)
{
  const Communicator comm;
  Options options;
  options.subdomains = 9;
  const auto d = cut_of(two_blocks("prism6", {6, 4, 4}, {6, 4, 4}), options, comm);
  const auto surface = boundary_surface(d, 4, {true, true});  // lower.zmin
  EXPECT_EQ(comm.sum(static_cast<long long>(surface.faces.size())), 2 * 6 * 4);
  std::set<Global> ids;
  for (const Global id : comm.all_gather(surface.face_id)) EXPECT_TRUE(ids.insert(id).second);
  EXPECT_EQ(comm.sum(static_cast<long long>(boundary_surface(d, 4, {false, true}).faces.size())), 0);
}

// 35 copies of a block, turned by an angle with no finite binary form, far from the origin.
mesh::Options ring_of_pads(const std::string& element)
{
  mesh::Options options;
  mesh::BlockOptions block;
  block.origin = {100, 3, -7};
  block.size = {2, 1, 1};
  block.cells = {6, 4, 4};
  block.element = element;
  options.blocks["pad"] = block;
  options.blocks["table"] = block;
  options.blocks["table"].origin = {0, 0, 50};
  mesh::InstanceOptions row;
  row.count = 35;
  row.rotate = mesh::RotationOptions{{1, 2, -0.5}, 360.0 / 35, {-3, 2, 1}};
  options.instances["pad"] = mesh::motions({row});
  return options;
}

TEST(Instances, AreCutAlikeAndFoundCongruent)
{
  const Communicator alone(MPI_COMM_SELF);
  Options metis;
  metis.unknowns_per_subdomain = 150;
  Options grid;
  grid.method = "grid";
  grid.counts = {{"pad", {2, 1, 2}}, {"table", {1, 1, 1}}};
  for (const auto& options : {metis, grid}) {
    const auto d = cut_of(ring_of_pads("tet4"), options, alone);
    ASSERT_EQ(d.catalogue.bodies.size(), 36U);
    const auto copies = congruent(d.subdomains, std::vector<int>(d.subdomains.size(), 0));
    std::map<int, std::vector<std::size_t>> of_body;
    for (std::size_t s = 0; s < d.subdomains.size(); ++s) of_body[d.subdomains[s].body].push_back(s);
    const auto& first = of_body.at(0);
    EXPECT_GT(first.size(), 2U);
    for (int b = 1; b < 35; ++b) {
      ASSERT_EQ(of_body.at(b).size(), first.size());
      for (std::size_t i = 0; i < first.size(); ++i) {
        const auto& copy = copies[of_body.at(b)[i]];
        EXPECT_EQ(copy.original, copies[first[i]].original) << "instance " << b + 1;
        EXPECT_TRUE(copy.rotation);
      }
    }
  }
}

TEST(Instances, OneBodyEachWithNumbersOfItsOwn)
{
  const Communicator comm, alone(MPI_COMM_SELF);
  Options options;
  options.unknowns_per_subdomain = 300;
  const auto d = cut_of(ring_of_pads("hex8"), options, comm);
  EXPECT_EQ(fingerprint(d, comm), fingerprint(cut_of(ring_of_pads("hex8"), options, alone), alone));
  EXPECT_EQ(d.catalogue.node_count, 36 * 7 * 5 * 5);
  EXPECT_EQ(d.catalogue.cell_count, 36 * 96);
  EXPECT_EQ(d.catalogue.bodies[34].name, "pad.35");
  std::vector<Global> nodes, cells;
  for (const auto& s : d.subdomains) {
    nodes.insert(nodes.end(), s.mesh.node_id.begin(), s.mesh.node_id.end());
    cells.insert(cells.end(), s.mesh.cell_id.begin(), s.mesh.cell_id.end());
  }
  nodes = comm.all_gather(nodes);
  cells = comm.all_gather(cells);
  EXPECT_EQ(std::set<Global>(nodes.begin(), nodes.end()).size(), static_cast<std::size_t>(d.catalogue.node_count));
  EXPECT_EQ(*std::max_element(nodes.begin(), nodes.end()), d.catalogue.node_count - 1);
  EXPECT_EQ(std::set<Global>(cells.begin(), cells.end()).size(), static_cast<std::size_t>(d.catalogue.cell_count));

  // The side of all pads, and of one: its 6 x 4 faces.
  const auto& names = d.catalogue.boundaries;
  const std::vector<bool> everywhere(d.catalogue.bodies.size(), true);
  const auto faces = [&](const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    EXPECT_LT(at, static_cast<std::ptrdiff_t>(names.size())) << name;
    return comm.sum(static_cast<long long>(boundary_surface(d, static_cast<int>(at), everywhere).faces.size()));
  };
  EXPECT_EQ(faces("pad.ymin"), 35 * 24);
  EXPECT_EQ(faces("pad.7.ymin"), 24);
  EXPECT_EQ(faces("table.ymin"), 24);
}

TEST(Instances, ATotalOfSubdomainsIsMetAsFarAsCopiesAllow)
{
  const Communicator alone(MPI_COMM_SELF);
  Options options;
  options.subdomains = 80;  // 35 pads and a table: two each, and what is left goes to the table
  EXPECT_EQ(cut_of(ring_of_pads("hex8"), options, alone).subdomain_count(), 80);
}

}  // namespace
}  // namespace mortise::partition
