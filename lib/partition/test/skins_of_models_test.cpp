// Skins of a cube, of wedges round an edge and of instances; bodies without one, and bodies that are taken whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "partition/congruence.hpp"
#include "partition/skin.hpp"
#include "partition/whole_bodies.hpp"
#include "skin_cases.hpp"

namespace mortise::partition {
namespace {

TEST(Skins, OfACubeIsWhatIsCountedByHand)
{
  const Communicator comm;
  mesh::Options cube;
  auto& block = cube.blocks["cube"];
  block.size = {1, 1, 1};
  block.cells = {10, 10, 10};
  block.element = "hex8";
  Options one;
  one.subdomains = 1;
  const auto d = skins(cut_of(cube, one, comm), {true}, true, comm);
  EXPECT_EQ(d.catalogue.node_count, 602);
  EXPECT_EQ(d.catalogue.cell_count, 1200);
  for (const auto& s : d.subdomains) {
    EXPECT_EQ(s.mesh.node_count(), 602U);
    EXPECT_EQ(s.mesh.cells.size(), 1200U);
    EXPECT_EQ(s.mesh.facets.cells.size(), 1200U);
    EXPECT_EQ(s.inside.node_count(), 1331U);
    EXPECT_EQ(edges(s.mesh.cells).crowded, 0);
  }
  Options grid;  // 2 x 2 x 2 subdomains of 5^3 cells: 152 nodes and 300 panels each, and copies of the first
  grid.method = "grid";
  grid.counts = {{"cube", {2, 2, 2}}};
  const auto parts = skins(cut_of(cube, grid, comm), {true}, false, comm);
  EXPECT_EQ(parts.catalogue.node_count, 1331 - 8 * 64);
  EXPECT_EQ(parts.catalogue.cell_count, 8 * 300);
  for (const auto& copy : congruent(parts.subdomains, std::vector<int>(parts.subdomains.size(), 0))) {
    EXPECT_EQ(copy.original, 0U);
    EXPECT_FALSE(copy.rotation);
  }
}

// An edge of a panel, from its corner `place`.
struct PanelEdge {
  Local low, high;  // its nodes
  bool along;       // whether the panel runs from low to high
  std::size_t panel, place;
};

// The angle, in (0, 2 pi], by which the panel of `from` has to be turned about the edge, through the solid behind it, to lie on
// that of `to`.
double angle_through_solid(const mesh::Mesh& skin, const PanelEdge& from, const PanelEdge& to)
{
  const auto point = [&](Local n) { return skin.points[static_cast<std::size_t>(n)]; };
  const Point origin = point(from.low), edge = (point(from.high) - origin).normalized();
  const auto away = [&](const PanelEdge& of) -> Point {  // in the panel, across the edge
    const Point x = point(skin.cells[of.panel][(of.place + 2) % 3]) - origin;
    return (x - x.dot(edge) * edge).normalized();
  };
  const Point own = away(from), other = away(to), outward = (from.along ? edge : Point(-edge)).cross(own);
  const double angle = std::atan2(-other.dot(outward), other.dot(own));
  return angle > 0 ? angle : angle + 2 * std::numbers::pi;
}

// For each panel of a skin in space the panels beyond its edges: [panel][k] across the edge from corner k to corner k + 1, which
// that panel has the other way. Where cells of a subdomain touch in an edge alone, four panels or more do; those are neighbours
// that bound the same wedge of the solid.
std::vector<std::array<Local, 3>> panel_neighbours(const mesh::Mesh& skin)
{
  std::vector<PanelEdge> edges;
  for (std::size_t p = 0; p < skin.cells.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k) {
      const Local a = skin.cells[p][k], b = skin.cells[p][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b, p, k});
    }
  std::sort(edges.begin(), edges.end(), [](const PanelEdge& a, const PanelEdge& b) {
    return std::tie(a.low, a.high, a.panel) < std::tie(b.low, b.high, b.panel);
  });
  std::vector<std::array<Local, 3>> result(skin.cells.size());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t j = begin; j < end; ++j) {
        if (edges[j].along == edges[i].along) continue;
        const double angle = end - begin == 2 ? 0 : angle_through_solid(skin, edges[i], edges[j]);
        if (angle >= least) continue;
        least = angle;
        result[edges[i].panel][edges[i].place] = static_cast<Local>(edges[j].panel);
      }
    }
  }
  return result;
}

// Cells round an edge, wedges of a turned cake of which some are missing: the skin of each wedge is closed in itself.
TEST(Skins, PanelsWhereCellsTouchInAnEdgeBelongToOneWedge)
{
  const Communicator alone(MPI_COMM_SELF);
  for (const double turned : {0.0, 1.3, 4.0}) {
    Decomposition d;
    d.catalogue.bodies = {{"cake", "cake"}};
    d.first = d.clusters = {0, 1};
    auto& mesh = d.subdomains.emplace_back().mesh;
    mesh.points = {{0, 0, 0}, {0, 0, 1}};
    const std::vector<std::pair<double, double>> wedges{{0, 1}, {2, 2.5}, {3, 5.5}};
    for (const auto& [from, to] : wedges) {
      const auto first = static_cast<Local>(mesh.points.size());
      for (const double z : {0.0, 1.0})
        for (const double angle : {from, (from + to) / 2, to})
          mesh.points.emplace_back(std::cos(angle + turned), std::sin(angle + turned), z);
      const Local f = first;
      mesh.cells.add(mesh::CellType::hex8, std::array{0, f, f + 1, f + 2, 1, f + 3, f + 4, f + 5});
      mesh.cell_id.push_back(static_cast<Global>(mesh.cell_id.size()));
      mesh.cell_body.push_back(0);
    }
    for (std::size_t n = 0; n < mesh.points.size(); ++n) mesh.node_id.push_back(static_cast<Global>(n));
    d.catalogue.node_count = static_cast<Global>(mesh.points.size());
    d = skins(d, {true}, false, alone);
    const auto& skin = d.subdomains[0].mesh;
    ASSERT_EQ(skin.cells.size(), 36U);
    EXPECT_EQ(edges(skin.cells).open, 0);
    EXPECT_EQ(edges(skin.cells).crowded, 1);
    const auto neighbours = panel_neighbours(skin);
    for (std::size_t p = 0; p < neighbours.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto other = static_cast<std::size_t>(neighbours[p][k]);
        EXPECT_EQ(other / 12, p / 12);  // 12 panels each
        const Local a = skin.cells[p][k], b = skin.cells[p][(k + 1) % 3];
        int shared = 0;
        for (std::size_t j = 0; j < 3; ++j)
          if (skin.cells[other][j] == b && skin.cells[other][(j + 1) % 3] == a) {
            ++shared;
            EXPECT_EQ(neighbours[other][j], static_cast<Local>(p));
          }
        EXPECT_EQ(shared, 1);
      }
  }
}

TEST(Skins, OfRotatedInstancesAreCopies)
{
  const Communicator alone(MPI_COMM_SELF);
  for (const char* element : {"hex8", "tet10", "prism6"}) {
    auto blocks = two_blocks(element, {6, 4, 4}, {4, 3, 2});
    mesh::InstanceOptions row;
    row.count = 7;
    row.rotate = mesh::RotationOptions{{1, 2, -0.5}, 360.0 / 7, {-3, 2, 1}};
    blocks.instances["upper"] = mesh::motions({row});
    const auto solids = cut_of(blocks, metis(60), alone), d = skins(solids, std::vector<bool>(8, true), false, alone);
    const std::vector<int> alike(d.subdomains.size(), 0);
    const auto before = congruent(solids.subdomains, alike), after = congruent(d.subdomains, alike);
    std::size_t copies = 0;
    for (std::size_t s = 0; s < alike.size(); ++s) {
      copies += before[s].original != s ? 1 : 0;
      EXPECT_EQ(before[s].original != s, after[s].original != s);
    }
    EXPECT_GT(copies, 11U);
  }
}

TEST(Skins, OfOtherBodiesNothingChanges)
{
  const Communicator comm;
  const auto solids = cut_of(cases[0], comm), same = skins(solids, {false, false}, true, comm),
             d = skins(solids, {false, true}, true, comm);
  EXPECT_EQ(same.catalogue.node_count, solids.catalogue.node_count);
  for (std::size_t s = 0; s < solids.subdomains.size(); ++s) {
    EXPECT_FALSE(same.subdomains[s].skin);
    EXPECT_EQ(same.subdomains[s].mesh.node_id, solids.subdomains[s].mesh.node_id);
    if (solids.subdomains[s].body != 0) continue;
    EXPECT_FALSE(d.subdomains[s].skin);
    EXPECT_EQ(d.subdomains[s].mesh.node_id, solids.subdomains[s].mesh.node_id);
    EXPECT_EQ(d.subdomains[s].mesh.cells.nodes, solids.subdomains[s].mesh.cells.nodes);
    EXPECT_EQ(d.subdomains[s].mesh.cell_id, solids.subdomains[s].mesh.cell_id);
  }
}

// Whole bodies: the solid in one piece, the skins as they are cut, with new numbers of subdomains.
TEST(Skins, StayWhereBodiesAreTakenWhole)
{
  const Communicator comm;
  for (const bool lower : {true, false}) {
    const auto d = skins(cut_of(cases[0], comm), {lower, !lower}, true, comm), whole = whole_bodies(d, comm);
    std::vector<double> skins_before(2, 0.0), now(2, 0.0);
    std::vector<double> before(4, 0.0), after(4, 0.0);  // cells and nodes of skins, and of what is inside
    const auto count = [](const Subdomain& s, std::vector<double>& sums) {
      if (!s.skin) return;
      sums[0] += static_cast<double>(s.mesh.cells.size());
      sums[1] += static_cast<double>(s.mesh.node_count());
      sums[2] += static_cast<double>(s.inside.cells.size());
      sums[3] += volume(s.mesh);
    };
    for (const auto& s : d.subdomains) skins_before[static_cast<std::size_t>(s.body)] += 1, count(s, before);
    Global next = whole.first[static_cast<std::size_t>(comm.rank())];
    for (const auto& s : whole.subdomains) {
      EXPECT_EQ(s.id, next++);
      EXPECT_EQ(s.skin, (s.body == 0) == lower);
      EXPECT_EQ(whole.rank_of(s.id), comm.rank());
      EXPECT_TRUE(!s.skin || edges(s.mesh.cells).open == 0);
      now[static_cast<std::size_t>(s.body)] += 1;
      count(s, after);
    }
    EXPECT_EQ(next, whole.first[static_cast<std::size_t>(comm.rank()) + 1]);
    comm.sum_in_place(skins_before);
    comm.sum_in_place(now);
    EXPECT_GT(skins_before[0], 2);
    EXPECT_GT(skins_before[1], 2);
    EXPECT_EQ(now[lower ? 0 : 1], skins_before[lower ? 0 : 1]);
    EXPECT_EQ(now[lower ? 1 : 0], 1);
    comm.sum_in_place(before);
    comm.sum_in_place(after);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(before[i], after[i]);
    EXPECT_NEAR(after[3], 2, 1e-12);
    EXPECT_EQ(whole.subdomain_count(), static_cast<Global>(now[0] + now[1]));
    EXPECT_EQ(static_cast<std::size_t>(whole.cluster_count()), static_cast<std::size_t>(whole.subdomain_count()));
  }
}

}  // namespace
}  // namespace mortise::partition
