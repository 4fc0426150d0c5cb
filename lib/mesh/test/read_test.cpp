// Files of every format are written by gmsh and read back.
#include "mesh/read.hpp"

#include <gmsh.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "base/error.hpp"
#include "mesh/shape_functions.hpp"
#include "scratch.hpp"

namespace mortise::mesh {
namespace {

using test::path;

std::string geo(const std::string& name, const std::string& text)
{
  std::ofstream(path(name)) << text;
  return path(name);
}

// Two unit cubes side by side that share the nodes of the face between them, each a body.
const char* two_cubes = R"(
SetFactory("OpenCASCADE");
DefineConstant[ n = 2 ];
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
Coherence;
Transfinite Curve {:} = n + 1; Transfinite Surface {:}; Transfinite Volume {:};
Physical Volume("left") = {1};
Physical Volume("right") = {2};
between() = Surface In BoundingBox {0.9, -0.1, -0.1, 1.1, 1.1, 1.1};
Physical Surface("between") = {between()};
bottom() = Surface In BoundingBox {-0.1, -0.1, -0.1, 2.1, 1.1, 0.1};
Physical Surface("bottom") = {bottom()};
Physical Surface("also_bottom") = {bottom()};
)";

Assembly read_file(const std::string& file, int dimension = 3, std::map<std::string, double> constants = {})
{
  Options options;
  options.file = file;
  options.constants = std::move(constants);
  return read(options, dimension);
}

void expect_two_cubes(const Assembly& assembly, int n)
{
  ASSERT_EQ(assembly.catalogue.bodies.size(), 2U);
  EXPECT_EQ(assembly.catalogue.bodies[0].name, "left");
  EXPECT_EQ(assembly.catalogue.boundaries, (std::vector<std::string>{"between", "bottom", "also_bottom"}));
  EXPECT_EQ(assembly.mesh.node_count(),
            2U * static_cast<unsigned>((n + 1) * (n + 1) * (n + 1)));  // the face between has two sets of nodes
  EXPECT_EQ(assembly.mesh.cells.size(), static_cast<std::size_t>(2 * 6 * n * n * n));
  Point sum = Point::Zero();
  int between = 0;
  for (std::size_t f = 0; f < assembly.mesh.facets.cells.size(); ++f) {
    const auto nodes = assembly.mesh.facets.cells[f];
    const auto& p = assembly.mesh.points;
    const Point area = 0.5 * (p[static_cast<std::size_t>(nodes[1])] - p[static_cast<std::size_t>(nodes[0])])
                                 .cross(p[static_cast<std::size_t>(nodes[2])] - p[static_cast<std::size_t>(nodes[0])]);
    if (assembly.mesh.facets.boundary[f] == 0) {
      ++between;
      const bool left = assembly.mesh.cell_body[static_cast<std::size_t>(assembly.mesh.facets.parent[f])] == 0;
      EXPECT_NEAR(area.normalized()[0], left ? 1 : -1, 1e-12);
    } else {
      sum += area;
    }
  }
  EXPECT_EQ(between, 2 * 2 * n * n);
  EXPECT_LT((sum - Point(0, 0, -4)).norm(), 1e-12);  // the bottom is on two boundaries
}

TEST(Read, EveryMshFormat)
{
  const auto source = geo("source.geo", two_cubes);
  for (const double version : {2.2, 4.1})
    for (const int binary : {0, 1}) {
      const auto file = path("cubes_" + std::to_string(version) + (binary != 0 ? "b" : "a") + ".msh");
      gmsh::initialize(0, nullptr, false);
      gmsh::option::setNumber("General.Terminal", 0);
      gmsh::open(source);
      gmsh::model::mesh::generate(3);
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
      gmsh::option::setNumber("Mesh.Binary", binary);
      gmsh::write(file);
      gmsh::finalize();
      SCOPED_TRACE(file);
      expect_two_cubes(read_file(file), 2);
    }
}

TEST(Read, PartsOfAGroupBecomeBodies)
{
  const auto assembly = read_file(geo("parts.geo", R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {3, 0, 0, 1, 1};
Rectangle(3) = {6, 0, 0, 1, 1};
Physical Surface("pads") = {1, 2};
Physical Surface("rest") = {3};
)"),
                                  2);
  ASSERT_EQ(assembly.catalogue.bodies.size(), 3U);
  EXPECT_EQ(assembly.catalogue.bodies[0].name, "pads.1");
  EXPECT_EQ(assembly.catalogue.bodies[1].name, "pads.2");
  EXPECT_EQ(assembly.catalogue.bodies[1].group, "pads");
  EXPECT_EQ(assembly.catalogue.bodies[2].name, "rest");
}

// The nodes of a physical curve have its length, those of an edge that two bodies share once each.
TEST(Read, PhysicalCurvesAndPointsAreNodesWithNames)
{
  for (const int order : {1, 2}) {
    const auto assembly = read_file(geo("edges.geo", R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 3};
Box(2) = {1, 0, 0, 1, 1, 3};
Coherence;
Physical Volume("a") = {1};
Physical Volume("b") = {2};
Physical Curve("own") = Curve In BoundingBox {-0.1, -0.1, -0.1, 0.1, 0.1, 3.1};
Physical Curve("shared") = Curve In BoundingBox {0.9, -0.1, -0.1, 1.1, 0.1, 3.1};
Physical Point("corner") = Point In BoundingBox {-0.1, -0.1, -0.1, 0.1, 0.1, 0.1};
Mesh.MeshSizeMax = 1;
Mesh.ElementOrder = )" + std::to_string(order) + ";\n"));
    const auto& sets = assembly.catalogue.node_sets;
    ASSERT_EQ(sets.size(), 3U);
    const auto length = [](const NodeSet& set) { return std::accumulate(set.weights.begin(), set.weights.end(), 0.0); };
    EXPECT_EQ(sets[0].name, "own");
    EXPECT_EQ(sets[0].nodes.size(), order == 1 ? 10U : 19U);
    EXPECT_NEAR(length(sets[0]), 3, 1e-12);
    EXPECT_EQ(sets[1].nodes.size(), order == 1 ? 20U : 38U);
    EXPECT_NEAR(length(sets[1]), 6, 1e-12);
    ASSERT_EQ(sets[2].nodes.size(), 1U);
    EXPECT_LT(assembly.mesh.points[static_cast<std::size_t>(sets[2].nodes[0])].norm(), 1e-12);
  }
}

TEST(Read, GeometryWithConstants)
{
  expect_two_cubes(read_file(geo("cubes.geo", two_cubes), 3, {{"n", 3}}), 3);
}

// Cells of second order, turned inside out in the file, are turned back with all their nodes.
TEST(Read, SecondOrderCells)
{
  const std::string volumes = "Transfinite Volume {:};", text = two_cubes;
  const auto at = text.find(volumes);
  for (const int incomplete : {0, 1})
    for (const std::string hexahedra : {"", "Recombine Surface {:}; "}) {
      SCOPED_TRACE(hexahedra + std::to_string(incomplete));
      const auto file =
          geo("second.geo", text.substr(0, at) + hexahedra + text.substr(at) +
                                "\nMesh.ElementOrder = 2;\nMesh.SecondOrderIncomplete = " + std::to_string(incomplete) + ";\n");
      const auto assembly = read_file(file);
      const auto& mesh = assembly.mesh;
      for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const auto type = mesh.cells.type[c];
        EXPECT_NE(type, first_order(type));
        Eigen::VectorXd value(node_count(type));
        Eigen::MatrixXd gradient;
        shape_functions(type).evaluate({0.1, 0.2, 0.3}, value, &gradient);
        Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < mesh.cells[c].size(); ++i)
          jacobian += mesh.points[static_cast<std::size_t>(mesh.cells[c][i])] * gradient.row(static_cast<Eigen::Index>(i));
        EXPECT_GT(jacobian.determinant(), 0);
        for (std::size_t m = 0; m < middles(type).size(); ++m) {  // straight cells: nodes are amid their corners
          Point sum = Point::Zero();
          for (const int k : middles(type)[m])
            sum += mesh.points[static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(k)])] /
                   static_cast<double>(middles(type)[m].size());
          EXPECT_LT((mesh.points[static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(corner_count(type)) + m])] - sum)
                        .norm(),
                    1e-12);
        }
      }
    }
}

// What the deck says of sizes and order outweighs what a geometry sets.
TEST(Read, DeckOutweighsGeometry)
{
  const auto file =
      geo("own_order.geo",
          "SetFactory(\"OpenCASCADE\");\nMesh.ElementOrder = 1;\nMesh.MeshSizeMax = 0.5;\nBox(1) = {0, 0, 0, 1, 1, 1};\n"
          "Physical Volume(\"box\") = {1};\n");
  Options options;
  options.file = file;
  const auto coarse = read(options, 3);
  options.order = 2;
  options.size.max = 0.1;
  const auto fine = read(options, 3);
  EXPECT_EQ(coarse.mesh.cells.type.front(), CellType::tet4);
  EXPECT_EQ(fine.mesh.cells.type.front(), CellType::tet10);
  EXPECT_GT(fine.mesh.cells.size(), 3 * coarse.mesh.cells.size());
}

void expect_error(const std::string& file, int dimension, const std::string& text)
{
  try {
    read_file(file, dimension);
    FAIL() << "no error for " << file;
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind(file, 0), 0U) << error.what();
  }
}

TEST(Read, MistakesAreExplained)
{
  const std::string square = "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\nRectangle(2) = {2, 0, 0, 1, 1};\n";
  expect_error(path("absent.msh"), 3, "no such file");
  // gmsh itself crashes on this one: a point that is said to lie inside a surface lies on its border.
  expect_error(geo("crash.geo",
                   "Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {1, 1, 0, 1}; Point(4) = {0, 1, 0, 1}; Point(5) "
                   "= {0.5, 0, 0, 1};\n"
                   "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\nCurve Loop(1) = {1, 2, 3, 4}; Plane "
                   "Surface(1) = {1};\n"
                   "Point{5} In Surface{1};\nPhysical Surface(\"a\") = {1};\n"),
               2, "gmsh");
  expect_error(geo("syntax.geo", "Point(1) = {0, 0"), 3, "gmsh");
  expect_error(geo("nameless.geo", square), 2, "Physical Surface");
  expect_error(geo("third.geo", square + "Mesh.ElementOrder = 3;\nPhysical Surface(\"a\") = {1, 2};\n"), 2, "order 2");
  expect_error(geo("forgotten.geo", square + "Physical Surface(\"a\") = {1};\nMesh.SaveAll = 1;\n"), 2,
               "belongs to no physical surface");
  expect_error(geo("twice.geo", square + "Physical Surface(\"a\") = {1, 2};\nPhysical Surface(\"b\") = {2};\n"), 2, "two bodies");
  expect_error(
      geo("loose.geo", square + "Line(77) = {1, 7};\nPhysical Curve(\"loose\") = {77};\nPhysical Surface(\"a\") = {1, 2};\n"), 2,
      "lie on no cell");
  expect_error(
      geo("high.geo", "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0.5, 1, 1};\nPhysical Surface(\"a\") = {1};\n"), 2,
      "z = 0");
}

}  // namespace
}  // namespace mortise::mesh
