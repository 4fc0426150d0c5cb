// Bricks, wedges and quadrilaterals that name nodes several times.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "base/error.hpp"
#include "mesh/topology.hpp"
#include "../src/raw_mesh.hpp"

namespace mortise::mesh {
namespace {

// One cell, alone in its volume, whose nodes stand at `points`.
RawMesh one_cell(CellType type, const std::vector<Local>& nodes, const std::vector<Point>& points)
{
  RawMesh raw;
  raw.points = points;
  raw.cells.add(type, nodes);
  raw.tag = {7};
  raw.volume = {0};
  raw.volumes = {"a"};
  return raw;
}

const std::vector<Point> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

// Every face of every cell must look outwards: the volume by the divergence theorem.
double volume(const Mesh& mesh)
{
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const auto& face : faces(first_order(mesh.cells.type[c]))) {
      const auto p = [&](std::size_t i) {
        return mesh.points[static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(face.nodes[i])])];
      };
      for (std::size_t i = 1; i + 1 < face.nodes.size(); ++i) sum += p(0).dot(p(i).cross(p(i + 1))) / 6;
    }
  return sum;
}

TEST(RepeatedNodes, BrickWithTwoEdgesOfAFaceClosedIsAWedge)
{
  int wedges = 0;
  for (const auto& face : faces(CellType::hex8))
    for (const std::size_t first : {0U, 1U}) {  // which two opposite edges of the face shrink
      std::vector<Local> nodes{0, 1, 2, 3, 4, 5, 6, 7};
      for (const std::size_t k : {0U, 2U}) {
        const auto keep = static_cast<std::size_t>(face.nodes[(first + k) % 4]);
        const auto gone = static_cast<std::size_t>(face.nodes[(first + k + 1) % 4]);
        nodes[k == 0 ? gone : keep] = static_cast<Local>(k == 0 ? keep : gone);
      }
      auto raw = one_cell(CellType::hex8, nodes, cube);
      const auto assembly = assemble(raw, {}, 3);
      EXPECT_EQ(assembly.mesh.cells.type[0], CellType::prism6);
      EXPECT_NEAR(volume(assembly.mesh), 0.5, 1e-14);
      ++wedges;
    }
  EXPECT_EQ(wedges, 12);
}

TEST(RepeatedNodes, Tetrahedra)
{
  for (const auto& nodes : {std::vector<Local>{0, 1, 2, 2, 4, 4, 4, 4}, {0, 0, 0, 0, 5, 6, 2, 2}}) {
    const auto assembly = assemble(one_cell(CellType::hex8, nodes, cube), {}, 3);
    EXPECT_EQ(assembly.mesh.cells.type[0], CellType::tet4);
    EXPECT_GT(volume(assembly.mesh), 0.1);
  }
  for (const auto& nodes : {std::vector<Local>{0, 1, 2, 4, 4, 4}, {0, 1, 2, 0, 1, 6}, {0, 1, 2, 0, 5, 2}})
    EXPECT_EQ(assemble(one_cell(CellType::prism6, nodes, cube), {}, 3).mesh.cells.type[0], CellType::tet4);
}

TEST(RepeatedNodes, TriangleAsQuadrilateral)
{
  for (const auto& nodes : {std::vector<Local>{0, 1, 2, 2}, {0, 0, 1, 2}, {0, 1, 1, 2}, {0, 1, 2, 0}, {2, 2, 1, 0}}) {
    const auto assembly = assemble(one_cell(CellType::quad4, nodes, cube), {}, 2);
    EXPECT_EQ(assembly.mesh.cells.type[0], CellType::tri3);
  }
}

TEST(RepeatedNodes, SecondOrder)
{
  for (const auto type : {CellType::hex20, CellType::hex27}) {
    // Nodes amid corners stand amid them; those amid one corner are that corner, and two edges that became one have one node.
    const std::vector<Local> corners{0, 1, 2, 2, 4, 5, 6, 6};
    auto points = cube;
    std::map<std::set<Local>, Local> amid;
    auto nodes = corners;
    for (const auto& middle : middles(type)) {
      std::set<Local> of;
      for (const int c : middle) of.insert(corners[static_cast<std::size_t>(c)]);
      if (of.size() == 1) {
        nodes.push_back(*of.begin());
        continue;
      }
      const auto [at, fresh] = amid.emplace(of, static_cast<Local>(points.size()));
      if (fresh) {
        Point sum = Point::Zero();
        for (const Local n : of) sum += cube[static_cast<std::size_t>(n)] / static_cast<double>(of.size());
        points.push_back(sum);
      }
      nodes.push_back(at->second);
    }
    const auto& mesh = assemble(one_cell(type, nodes, points), {}, 3).mesh;
    ASSERT_EQ(mesh.cells.type[0], type == CellType::hex20 ? CellType::prism15 : CellType::prism18);
    for (std::size_t m = 0; m < middles(mesh.cells.type[0]).size(); ++m) {
      Point sum = mesh.points[static_cast<std::size_t>(mesh.cells[0][6 + m])];
      const auto& of = middles(mesh.cells.type[0])[m];
      for (const int c : of)
        sum -= mesh.points[static_cast<std::size_t>(mesh.cells[0][static_cast<std::size_t>(c)])] / static_cast<double>(of.size());
      EXPECT_LT(sum.norm(), 1e-14);
    }
  }
}

TEST(RepeatedNodes, FacesOfBoundariesFollow)
{
  auto raw = one_cell(CellType::hex8, {0, 1, 2, 2, 4, 5, 6, 6}, cube);
  const std::array<Local, 4> bottom{0, 1, 2, 2}, closed{2, 2, 6, 6};
  raw.boundaries.push_back({"bottom", -1, {face_key(bottom)}, true});
  raw.boundaries.push_back({"closed", -1, {face_key(closed)}, true});
  const auto assembly = assemble(raw, {}, 3);
  ASSERT_EQ(assembly.mesh.facets.cells.size(), 1U);
  EXPECT_EQ(assembly.mesh.facets.cells.type[0], CellType::tri3);
  EXPECT_EQ(assembly.mesh.facets.boundary[0], 0);
  ASSERT_EQ(assembly.warnings.size(), 1U) << "of the face that is an edge nothing is left";
}

TEST(RepeatedNodes, WhatIsNoCellIsRefused)
{
  const auto refused = [](CellType type, const std::vector<Local>& nodes, int dimension, const std::string& words) {
    try {
      assemble(one_cell(type, nodes, cube), {}, dimension);
      ADD_FAILURE() << fmt::format("{}", fmt::join(nodes, " "));
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("element 7"), std::string::npos) << error.what();
    }
  };
  refused(CellType::hex8, {0, 1, 2, 3, 4, 4, 4, 4}, 3, "5 corners");       // a pyramid
  refused(CellType::hex8, {0, 1, 2, 2, 4, 5, 6, 7}, 3, "7 corners");       // one edge closed
  refused(CellType::hex8, {0, 1, 2, 3, 0, 1, 6, 7}, 3, "more than once");  // folds a face
  refused(CellType::hex8, {0, 0, 0, 0, 0, 0, 0, 0}, 3, "1 corners");
  refused(CellType::hex8, {0, 6, 2, 6, 4, 5, 6, 7}, 3, "more than once");
  refused(CellType::prism6, {0, 1, 2, 4, 5, 5}, 3, "5 corners");
  refused(CellType::tet4, {0, 1, 2, 2}, 3, "3 corners");
  refused(CellType::quad4, {0, 1, 0, 2}, 2, "3 corners");
  refused(CellType::tri3, {0, 1, 1}, 2, "2 corners");
  auto points = cube;
  points[3] = points[2];
  points[7] = points[6];
  try {
    assemble(one_cell(CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}, points), {}, 3);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("two nodes in one place"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace mortise::mesh
