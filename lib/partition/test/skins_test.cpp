// Skins enclose what the cells fill: closed, turned outward, the same from both sides of an interface, and on the body's surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "partition/node_directory.hpp"
#include "partition/skin.hpp"
#include "skin_cases.hpp"

namespace mortise::partition {
namespace {

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

}  // namespace
}  // namespace mortise::partition
