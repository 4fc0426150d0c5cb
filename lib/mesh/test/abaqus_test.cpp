#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/error.hpp"
#include "mesh/read.hpp"
#include "scratch.hpp"

namespace mortise::mesh {
namespace {

using test::path;

Assembly read_text(const std::string& text, int dimension = 3)
{
  Options options;
  options.file = path("model.inp");
  std::ofstream(options.file) << text;
  return read(options, dimension);
}

// Two bricks on top of each other with common nodes 5 to 8.
const std::string nodes = R"(*HEADING
two bricks
** a comment
*NODE, NSET=Nall
1, 0, 0, 0
2, 1.0E0, 0, 0
3, 1., 1.D0, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
9, 0, 0, 2
10, 1, 0, 2
11, 1, 1, 2
12, 0, 1, 2
)";
const std::string bricks = R"(*ELEMENT, TYPE=C3D8I, ELSET=Lower
10, 1, 2, 3, 4,
    5, 6, 7, 8
*element, type=C3D8, elset=upper
20, 5, 6, 7, 8, 9, 10, 11, 12
)";

// Facets of a boundary, and the sum of their area vectors.
std::pair<int, Point> facets(const Assembly& assembly, const std::string& name)
{
  const auto& all = assembly.catalogue.boundaries;
  const auto index = std::find(all.begin(), all.end(), name) - all.begin();
  EXPECT_LT(index, static_cast<std::ptrdiff_t>(all.size())) << name;
  int count = 0;
  Point sum = Point::Zero();
  const auto& mesh = assembly.mesh;
  for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
    if (mesh.facets.boundary[f] != index) continue;
    ++count;
    const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(mesh.facets.cells[f][i])]; };
    sum += 0.5 * (p(2) - p(0)).cross(p(3) - p(1));
  }
  return {count, sum};
}

TEST(Abaqus, BodiesAndBoundaries)
{
  const auto assembly = read_text(nodes + bricks + R"(*SURFACE, NAME=Top, TYPE=ELEMENT
UPPER, S2
*SURFACE, NAME=between
20, S1
*NSET, NSET=ground, GENERATE
1, 4, 1
*NSET, NSET=corner
1
*NSET, NSET=side
1, 2, 5, 6
ground
*MATERIAL, NAME=steel
*ELASTIC
210000, 0.3
*STEP
*STATIC
*NSET, NSET=ignored
1, 2, 3, 4
)");
  ASSERT_EQ(assembly.catalogue.bodies.size(), 2U);
  EXPECT_EQ(assembly.catalogue.bodies[0].name, "Lower");
  EXPECT_EQ(assembly.catalogue.bodies[1].name, "upper");
  EXPECT_EQ(assembly.mesh.node_count(), 16U);  // four stand twice
  EXPECT_LT((facets(assembly, "Top").second - Point(0, 0, 1)).norm(), 1e-15);
  EXPECT_EQ(facets(assembly, "between").first, 2);  // once for each body
  EXPECT_LT((facets(assembly, "ground").second - Point(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((facets(assembly, "side").second - Point(0, -1, -1)).norm(), 1e-15);
  EXPECT_EQ(facets(assembly, "Nall").first, 12);
  const auto& names = assembly.catalogue.boundaries;
  EXPECT_EQ(std::count(names.begin(), names.end(), "corner") + std::count(names.begin(), names.end(), "ignored"), 0);
  ASSERT_EQ(assembly.catalogue.node_sets.size(), 1U);  // without a whole face: nodes
  EXPECT_EQ(assembly.catalogue.node_sets[0].name, "corner");
  ASSERT_EQ(assembly.warnings.size(), 1U);
  EXPECT_NE(assembly.warnings[0].find("*MATERIAL"), std::string::npos);
}

TEST(Abaqus, EveryFaceOfABrick)
{
  const std::map<int, Point> outward{{1, {0, 0, -1}}, {2, {0, 0, 1}}, {3, {0, -1, 0}},
                                     {4, {1, 0, 0}},  {5, {0, 1, 0}}, {6, {-1, 0, 0}}};
  for (const auto& [side, normal] : outward) {
    const auto assembly = read_text(nodes + bricks + "*SURFACE, NAME=it\n10, S" + std::to_string(side) + "\n");
    const auto [count, sum] = facets(assembly, "it");
    if (side == 2)
      EXPECT_EQ(count, 2);  // the other brick is there
    else
      EXPECT_LT((sum - normal).norm(), 1e-15) << side;
  }
}

TEST(Abaqus, WhichSetsAreBodies)
{
  const std::string cells = "*ELEMENT, TYPE=C3D8, ELSET=Eall\n10, 1,2,3,4,5,6,7,8\n20, 5,6,7,8,9,10,11,12\n";
  const std::string sets = "*ELSET, ELSET=a\n10\n*ELSET, ELSET=b\n20\n";
  EXPECT_EQ(read_text(nodes + cells).catalogue.bodies.size(), 1U);
  EXPECT_EQ(read_text(nodes + cells + sets).catalogue.bodies.size(), 2U);
  const std::string third = "*ELSET, ELSET=c\n20\n";
  EXPECT_EQ(read_text(nodes + cells + sets + third).catalogue.bodies.size(), 1U);  // those of *ELEMENT hold every cell once
  EXPECT_EQ(read_text(nodes + bricks + third).catalogue.bodies.size(), 2U);
  const auto by_section =
      read_text(nodes + cells + sets + third + "*SOLID SECTION, ELSET=a, MATERIAL=m\n1.\n*SOLID SECTION, ELSET=c\n");
  EXPECT_EQ(by_section.catalogue.bodies[1].name, "c");
}

void expect_error(const std::string& text, const std::string& part)
{
  try {
    read_text(text);
    ADD_FAILURE() << "no error: " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Abaqus, WhatIsNotUnderstoodIsRefused)
{
  expect_error(nodes + "*INCLUDE, INPUT=other.inp\n", "model.inp:17: the card *INCLUDE is not understood");
  expect_error("*PART, NAME=p\n" + nodes, "model.inp:1: the card *PART");
  expect_error("*NODE, INPUT=nodes.txt\n", "model.inp:1: the lines of *NODE are in the file \"nodes.txt\"");
  expect_error(nodes + "*ELEMENT, TYPE=C3D5, ELSET=e\n1, 1,2,3,4,5\n", "elements of type C3D5");
  expect_error(nodes + "*ELEMENT, TYPE=C3D8, ELSET=e\n1, 1,2,3,4,5,6,7\n", "element 1 has 7 nodes, its type needs 8");
  expect_error(nodes + "*ELEMENT, TYPE=C3D8, ELSET=e\n1, 1,2,3,4,5,6,7,99\n", "the node 99");
  expect_error(nodes + "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n", "has no ELSET of cells");
  expect_error(nodes + bricks + "*SURFACE, NAME=s\nnobody, S1\n", "the ELSET \"nobody\"");
  expect_error(nodes + bricks + "*SURFACE, NAME=s\n10, S7\n", "a face S1 to S6");
  expect_error(nodes + bricks + "*SOLID SECTION, ELSET=Lower\n", "element 20 is in no ELSET");
  expect_error("*NODE\n1, 0, x, 0\n", "model.inp:2: expected a coordinate");
  expect_error("", "holds no *NODE");
}

// The upper brick's top stands below the lower one: the brick is turned back as a whole, into its neighbour.
TEST(Abaqus, CellsThatFoldIntoEachOtherAreRefused)
{
  auto folded = nodes;
  for (const char* z : {" 0, 0, 2", " 1, 0, 2", " 1, 1, 2", " 0, 1, 2"}) {
    auto below = std::string(z);
    below.replace(below.size() - 1, 1, "-3");
    folded.replace(folded.find(z), below.size() - 1, below);
  }
  expect_error(folded + bricks + "*ELSET, ELSET=all\n10, 20\n*SOLID SECTION, ELSET=all\n",
               "elements 10 and 20 of body \"all\" lie on the same side");
  try {  // the second triangle lies in the first
    read_text("*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n4, 0.2, 0.2\n*ELEMENT, TYPE=CPE3, ELSET=all\n1, 1, 2, 3\n2, 1, 2, 4\n", 2);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("elements 1 and 2"), std::string::npos) << error.what();
  }
  EXPECT_EQ(read_text(nodes + bricks + "*ELSET, ELSET=all\n10, 20\n*SOLID SECTION, ELSET=all\n").catalogue.bodies.size(), 1U);
}

// Two triangles of second order on one edge, from its corners 2 and 3, and a node between each pair of corners.
TEST(Abaqus, NeighboursWithOtherNodesBetweenTheirCornersAreRefused)
{
  const auto square = [](const char* middles) {
    return read_text(
        std::string(
            "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n4, 1, 1\n5, 0.5, 0\n6, 0.5, 0.5\n7, 0, 0.5\n8, 1, 0.5\n9, 0.5, 1\n"
            "10, 0.5, 0.5\n11, 0.6, 0.6\n12, 0.52, 0.52\n*ELEMENT, TYPE=CPE6, ELSET=all\n1, 1, 2, 3, 5, 6, 7\n2, 2, 4, 3, ") +
            middles + "\n",
        2);
  };
  EXPECT_EQ(square("8, 9, 6").catalogue.bodies.size(), 1U);
  EXPECT_EQ(square("8, 9, 11").catalogue.bodies.size(), 1U) << "a hole between two arcs";
  for (const auto& [middles, what] :
       {std::pair("8, 9, 10", "but not the nodes between them: these are twice"), std::pair("8, 9, 12", "or nearly; merge them"),
        std::pair("6, 9, 8", "element 2 has them in another order")})
    try {
      square(middles);
      ADD_FAILURE() << middles;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
}

// gmsh writes Abaqus' order of nodes: every node in the middle must lie amid its corners again.
void expect_straight(const std::string& geometry, int dimension, CellType type)
{
  const auto source = path("source.geo"), file = path("written.inp");
  std::ofstream(source) << geometry;
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(source);
  gmsh::model::mesh::generate(dimension);
  gmsh::write(file);
  gmsh::finalize();
  Options options;
  options.file = file;
  const auto assembly = read(options, dimension);
  ASSERT_EQ(assembly.mesh.cells.type[0], type);
  for (std::size_t c = 0; c < assembly.mesh.cells.size(); ++c) {
    const auto cell = assembly.mesh.cells[c];
    for (std::size_t m = 0; m < middles(type).size(); ++m) {
      Point mean = Point::Zero();
      for (const int corner : middles(type)[m])
        mean += assembly.mesh.points[static_cast<std::size_t>(cell[static_cast<std::size_t>(corner)])];
      mean /= static_cast<double>(middles(type)[m].size());
      const auto node = cell[static_cast<std::size_t>(corner_count(type)) + m];
      EXPECT_LT((assembly.mesh.points[static_cast<std::size_t>(node)] - mean).norm(), 1e-9);
    }
  }
  const auto& boundaries = assembly.catalogue.boundaries;
  EXPECT_TRUE(std::find(boundaries.begin(), boundaries.end(), "ground") != boundaries.end());
}

TEST(Abaqus, SecondOrderFromGmsh)
{
  const std::string box = R"(SetFactory("OpenCASCADE"); Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1;
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Volume("box") = {1}; Physical Surface("ground") = {Surface In BoundingBox {-0.1, -0.1, -0.1, 1.1, 1.1, 0.1}};
)";
  const std::string grid = "Transfinite Curve {:} = 3; Transfinite Surface {:}; Transfinite Volume {:};\n";
  expect_straight(box + grid, 3, CellType::tet10);
  expect_straight(box + grid + "Recombine Surface {:};\n", 3, CellType::hex20);
  const std::string plate = R"(SetFactory("OpenCASCADE"); Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1;
Rectangle(1) = {0, 0, 0, 1, 1};
Physical Surface("plate") = {1}; Physical Curve("ground") = {1};
Transfinite Curve {:} = 3; Transfinite Surface {:};
)";
  expect_straight(plate, 2, CellType::tri6);
  expect_straight(plate + "Recombine Surface {:};\n", 2, CellType::quad8);
}

}  // namespace
}  // namespace mortise::mesh
