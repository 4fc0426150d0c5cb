// Skins enclose what the cells fill: closed, turned outward, the same from both sides of an interface, and on the body's surface.
#include "partition/skins.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "mesh/topology.hpp"
#include "partition/congruence.hpp"
#include "partition/decompose.hpp"
#include "partition/node_directory.hpp"
#include "partition/skin.hpp"
#include "partition/whole_bodies.hpp"
#include "testing/cut.hpp"

namespace mortise::partition {
namespace {

Options metis(int unknowns)
{
  Options options;
  options.unknowns_per_subdomain = unknowns;
  return options;
}

const Point& at(const mesh::Mesh& mesh, Local node)
{
  return mesh.points[static_cast<std::size_t>(node)];
}

// Area times outward normal of a flat triangle, or of a line in a plane.
Point normal(const std::vector<Point>& points, std::span<const Local> nodes)
{
  const auto x = [&](std::size_t i) { return points[static_cast<std::size_t>(nodes[i])]; };
  if (nodes.size() == 2) return {x(1)[1] - x(0)[1], x(0)[0] - x(1)[0], 0};
  return 0.5 * (x(1) - x(0)).cross(x(2) - x(0));
}

// By the divergence theorem: the integral of x.n over the panels is dimension times the volume.
double volume(const mesh::Mesh& skin)
{
  double sum = 0;
  for (std::size_t c = 0; c < skin.cells.size(); ++c) {
    Point middle = Point::Zero();
    for (const Local n : skin.cells[c]) middle += at(skin, n);
    sum += middle.dot(normal(skin.points, skin.cells[c])) / static_cast<double>(skin.cells[c].size());
  }
  return sum / (skin.cells.type.front() == mesh::CellType::line2 ? 2 : 3);
}

// Of straight cells: through the triangles from a node of each face's corners.
double volume_of_cells(const mesh::Mesh& mesh)
{
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    const Point origin = at(mesh, nodes[0]);
    for (const auto& face : mesh::faces(mesh.cells.type[c])) {
      const auto x = [&](int i) -> Point {
        return at(mesh, nodes[static_cast<std::size_t>(face.nodes[static_cast<std::size_t>(i)])]) - origin;
      };
      const int corners = mesh::corner_count(face.type);
      if (corners == 2) sum += (x(0)[0] * x(1)[1] - x(0)[1] * x(1)[0]) / 2;
      for (int k = 2; k < corners; ++k) sum += x(0).dot(x(k - 1).cross(x(k))) / 6;
    }
  }
  return sum;
}

// How often each edge of the panels (plane models: each end) is run along, less how often the other way: of a closed skin 0. And
// how many edges belong to more than two panels.
struct Edges {
  int open = 0, crowded = 0;
};
Edges edges(const mesh::Cells& panels)
{
  std::map<std::pair<Local, Local>, std::pair<int, int>> all;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const auto n = panels[p];
    if (n.size() == 2) {
      ++all[{n[0], n[0]}].first;
      ++all[{n[1], n[1]}].second;
    }
    for (std::size_t k = 0; n.size() == 3 && k < 3; ++k) {
      const Local a = n[k], b = n[(k + 1) % 3];
      auto& count = all[{std::min(a, b), std::max(a, b)}];
      ++(a < b ? count.first : count.second);
    }
  }
  Edges result;
  for (const auto& [edge, count] : all) {
    result.open += count.first != count.second ? 1 : 0;
    result.crowded += count.first > 1 ? 1 : 0;
  }
  return result;
}

// Of the facets of each boundary: their number and their areas, exact for flat faces. Over all ranks.
std::vector<double> areas(const Decomposition& d, const Communicator& comm)
{
  std::vector<double> sums(4 * d.catalogue.boundaries.size(), 0.0);
  for (const auto& subdomain : d.subdomains) {
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.cells.size(); ++f) {
      auto nodes = facets.cells[f].first(static_cast<std::size_t>(mesh::corner_count(facets.cells.type[f])));
      Point sum = nodes.size() == 2 ? normal(subdomain.mesh.points, nodes) : Point(Point::Zero());
      for (std::size_t k = 2; k < nodes.size(); ++k)
        sum += normal(subdomain.mesh.points, std::array{nodes[0], nodes[k - 1], nodes[k]});
      for (Eigen::Index c = 0; c < 3; ++c)
        sums[4 * static_cast<std::size_t>(facets.boundary[f]) + static_cast<std::size_t>(c)] += sum[c];
      sums[4 * static_cast<std::size_t>(facets.boundary[f]) + 3] += sum.norm();
    }
  }
  comm.sum_in_place(sums);
  return sums;
}

struct Case {
  std::string element;
  int dimension;
  int unknowns;
};
const std::vector<Case> cases{{"hex8", 3, 60},   {"tet4", 3, 60},     {"prism6", 3, 60},   {"hex20", 3, 200}, {"hex27", 3, 600},
                              {"tet10", 3, 600}, {"prism15", 3, 300}, {"prism18", 3, 600}, {"quad4", 2, 15},  {"tri3", 2, 15},
                              {"quad8", 2, 40},  {"quad9", 2, 40},    {"tri6", 2, 40}};

Decomposition cut_of(const Case& c, const Communicator& comm)
{
  return cut_of(two_blocks(c.element, {6, 4, 4}, {4, 3, 2}, c.dimension == 2), metis(c.unknowns), comm, c.dimension);
}

TEST(Skins, EncloseWhatTheCellsFill)
{
  const Communicator comm;
  for (const auto& c : cases) {
    SCOPED_TRACE(c.element);
    const auto solids = cut_of(c, comm);
    ASSERT_GT(solids.subdomain_count(), 6);
    const auto d = skins(solids, {true, true}, true, comm);
    ASSERT_EQ(d.subdomains.size(), solids.subdomains.size());
    EXPECT_EQ(d.first, solids.first);
    EXPECT_EQ(d.clusters, solids.clusters);
    for (std::size_t s = 0; s < d.subdomains.size(); ++s) {
      const auto &solid = solids.subdomains[s].mesh, &skin = d.subdomains[s].mesh;
      EXPECT_TRUE(d.subdomains[s].skin);
      EXPECT_EQ(d.subdomains[s].id, solids.subdomains[s].id);
      const double filled = volume_of_cells(solid);
      EXPECT_GT(filled, 0);
      EXPECT_NEAR(volume(skin), filled, 1e-12 * filled);
      EXPECT_EQ(edges(skin.cells).open, 0);
      EXPECT_TRUE(std::is_sorted(skin.node_id.begin(), skin.node_id.end()));
      EXPECT_EQ(std::set<Local>(skin.cells.nodes.begin(), skin.cells.nodes.end()).size(), skin.node_count());
      for (const auto type : skin.cells.type) EXPECT_EQ(type, c.dimension == 2 ? mesh::CellType::line2 : mesh::CellType::tri3);
      EXPECT_EQ(skin.cell_body, std::vector<int>(skin.cells.size(), d.subdomains[s].body));
      EXPECT_EQ(surface_nodes(d.subdomains[s]).size(), skin.node_count());
      EXPECT_EQ(surface_nodes(solids.subdomains[s]).size(), skin.node_count());
      // Flat faces: the panels of a face point the way that it points.
      for (std::size_t p = 0; p < skin.cells.size(); ++p) EXPECT_GT(normal(skin.points, skin.cells[p]).norm(), 1e-4);

      const auto& inside = d.subdomains[s].inside;
      EXPECT_EQ(inside.node_count(), solid.node_count());
      EXPECT_EQ(inside.cell_id, solid.cell_id);
      EXPECT_NEAR(volume_of_cells(inside), filled, 1e-12 * filled);
      for (std::size_t n = 0; n < skin.node_count(); ++n) {
        EXPECT_EQ(inside.node_id[n], skin.node_id[n]);
        EXPECT_EQ(inside.points[n], skin.points[n]);
      }
      for (std::size_t n = skin.node_count(); n < inside.node_count(); ++n) EXPECT_GE(inside.node_id[n], d.catalogue.node_count);
      EXPECT_TRUE(std::is_sorted(inside.node_id.begin(), inside.node_id.end()));
    }
  }
}

TEST(Skins, AreNumberedWithoutGapsAlikeOnAllRanks)
{
  const Communicator comm, alone(MPI_COMM_SELF);
  for (const auto& c : cases)
    for (const auto& of_body : {std::vector<bool>{true, true}, {true, false}, {false, true}}) {
      SCOPED_TRACE(c.element);
      const auto d = skins(cut_of(c, comm), of_body, false, comm), whole = skins(cut_of(c, alone), of_body, true, alone);
      const auto all = [](const Decomposition& from, const Communicator& on) {
        std::vector<Global> nodes, cells, panels;
        for (const auto& s : from.subdomains) {
          nodes.insert(nodes.end(), s.mesh.node_id.begin(), s.mesh.node_id.end());
          cells.insert(cells.end(), s.mesh.cell_id.begin(), s.mesh.cell_id.end());
          for (const Local n : s.mesh.cells.nodes) panels.push_back(s.mesh.node_id[static_cast<std::size_t>(n)]);
          for (std::size_t f = 0; f < s.mesh.facets.cells.size(); ++f) panels.push_back(face_number(s.mesh, f));
        }
        return std::array{on.all_gather(nodes), on.all_gather(cells), on.all_gather(panels)};
      };
      const auto numbers = all(d, comm);
      EXPECT_EQ(numbers, all(whole, alone));
      for (const auto& s : d.subdomains) {
        EXPECT_EQ(s.skin, of_body[static_cast<std::size_t>(s.body)]);
        EXPECT_EQ(s.inside.node_count(), 0U);
      }
      const std::set<Global> nodes(numbers[0].begin(), numbers[0].end()), cells(numbers[1].begin(), numbers[1].end());
      EXPECT_EQ(static_cast<Global>(nodes.size()), d.catalogue.node_count);
      EXPECT_EQ(*nodes.rbegin(), d.catalogue.node_count - 1);
      EXPECT_EQ(static_cast<Global>(cells.size()), d.catalogue.cell_count);
      EXPECT_EQ(*cells.rbegin(), d.catalogue.cell_count - 1);
      EXPECT_EQ(numbers[1].size(), cells.size());
      std::set<Global> inside;
      for (const auto& s : whole.subdomains)
        if (s.skin)
          inside.insert(s.inside.node_id.begin() + static_cast<std::ptrdiff_t>(s.mesh.node_count()), s.inside.node_id.end());
      if (!inside.empty()) {
        EXPECT_EQ(*inside.begin(), whole.catalogue.node_count);
        EXPECT_EQ(*inside.rbegin(), whole.catalogue.node_count + static_cast<Global>(inside.size()) - 1);
      }
    }
}

// Every panel is on the outside of the body, or its mirror image is a panel of a neighbour: as many as faces demand.
TEST(Skins, NeighboursHaveTheSamePanelsMirrored)
{
  const Communicator comm;
  for (const auto& c : cases) {
    SCOPED_TRACE(c.element);
    const auto solids = cut_of(c, comm);
    const auto d = skins(solids, {true, true}, false, comm);
    std::vector<Global> own;  // corners of the panels, first the smallest
    for (const auto& s : d.subdomains)
      for (std::size_t p = 0; p < s.mesh.cells.size(); ++p) {
        std::vector<Global> corners;
        for (const Local n : s.mesh.cells[p]) corners.push_back(s.mesh.node_id[static_cast<std::size_t>(n)]);
        if (c.dimension == 3) std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        corners.resize(3, -1);
        own.insert(own.end(), corners.begin(), corners.end());
      }
    const auto all = comm.all_gather(own);
    std::set<std::array<Global, 3>> panels;
    for (std::size_t i = 0; i < all.size(); i += 3) EXPECT_TRUE(panels.insert({all[i], all[i + 1], all[i + 2]}).second);
    long long without = 0;
    for (const auto& [i, j, k] : panels) without += panels.contains(k < 0 ? std::array{j, i, k} : std::array{i, k, j}) ? 0 : 1;
    const auto surface = outer_surface(d, comm);
    EXPECT_EQ(comm.sum(static_cast<long long>(surface.faces.size())), without);
    EXPECT_LT(without, static_cast<long long>(panels.size()));

    // The outside of the bodies, 10 and 10 (in a plane 6 and 6), of as many panels as its faces make.
    std::vector<double> area(2, 0.0);
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
      area[static_cast<std::size_t>(surface.body[f])] += normal(surface.points, surface.faces[f]).norm();
    comm.sum_in_place(area);
    for (const double a : area) EXPECT_NEAR(a, c.dimension == 2 ? 6 : 10, 1e-12);
    const auto faces = outer_surface(solids, comm);
    std::array<long long, mesh::cell_types> pieces{};
    using enum mesh::CellType;
    for (const auto& [type, count] : {std::pair{line2, 1}, {tri3, 1}, {line3, 2}, {quad4, 2}, {tri6, 4}, {quad8, 6}, {quad9, 8}})
      pieces[static_cast<std::size_t>(type)] = count;
    long long expected = 0;
    for (const auto type : faces.faces.type) expected += pieces[static_cast<std::size_t>(type)];
    EXPECT_EQ(without, comm.sum(expected));

    // The numbers of faces are those of their boundary facets.
    std::set<Global> numbers(surface.face_id.begin(), surface.face_id.end()), named;
    EXPECT_EQ(numbers.size(), surface.face_id.size());
    for (const auto& s : d.subdomains)
      for (std::size_t f = 0; f < s.mesh.facets.cells.size(); ++f) {
        EXPECT_TRUE(numbers.contains(face_number(s.mesh, f)));
        EXPECT_TRUE(named.insert(face_number(s.mesh, f)).second);
        const auto parent = s.mesh.cells[static_cast<std::size_t>(s.mesh.facets.parent[f])], facet = s.mesh.facets.cells[f];
        EXPECT_TRUE(std::equal(parent.begin(), parent.end(), facet.begin(), facet.end()));
      }
    EXPECT_EQ(named, numbers);  // each face of a block is on a boundary
  }
}

TEST(Skins, BoundariesKeepTheirAreasAndNormals)
{
  const Communicator comm;
  for (const auto& c : cases) {
    SCOPED_TRACE(c.element);
    const auto solids = cut_of(c, comm);
    const auto before = areas(solids, comm), after = areas(skins(solids, {true, true}, false, comm), comm);
    ASSERT_EQ(before.size(), after.size());
    ASSERT_FALSE(before.empty());
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-12);
  }
}

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
