// Bodies that a file holds as closed surfaces: turned outward, with their cavities, whatever the file's cells look like.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "base/error.hpp"
#include "mesh/read.hpp"
#include "scratch.hpp"

namespace mortise::mesh {
namespace {

using test::path;

// Triangles, or lines of a plane model, of named physical surfaces.
class Soup {
 public:
  explicit Soup(int corners = 3) : corners_(corners) {}

  int group(const std::string& name)
  {
    names_.push_back(name);
    return static_cast<int>(names_.size());
  }
  int node(const Point& x)
  {
    points_.push_back(x);
    return static_cast<int>(points_.size());
  }
  void cell(int group, std::vector<int> nodes) { cells_.push_back({group, std::move(nodes)}); }
  void remove_last() { cells_.pop_back(); }

  // Every other cell is turned.
  void cube(int group, const Point& centre, double edge)
  {
    std::vector<int> n;
    for (int k = 0; k < 8; ++k) {
      Point x;
      for (int axis = 0; axis < 3; ++axis) x[axis] = centre[axis] + edge * ((k >> axis & 1) - 0.5);
      n.push_back(node(x));
    }
    const int sides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& s : sides) {
      cell(group, {n[static_cast<std::size_t>(s[0])], n[static_cast<std::size_t>(s[1])], n[static_cast<std::size_t>(s[2])]});
      cell(group, {n[static_cast<std::size_t>(s[3])], n[static_cast<std::size_t>(s[2])], n[static_cast<std::size_t>(s[0])]});
    }
  }
  void square(int group, double x, double y, double edge, bool turned)
  {
    std::vector<int> n{node({x, y, 0}), node({x + edge, y, 0}), node({x + edge, y + edge, 0}), node({x, y + edge, 0})};
    if (turned) std::swap(n[1], n[3]);
    for (std::size_t k = 0; k < 4; ++k) cell(group, {n[k], n[(k + 1) % 4]});
  }

  std::string msh(const std::string& name) const
  {
    std::ofstream out(path(name));
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << names_.size() << "\n";
    for (std::size_t g = 0; g < names_.size(); ++g) out << corners_ - 1 << " " << g + 1 << " \"" << names_[g] << "\"\n";
    out << "$EndPhysicalNames\n$Nodes\n" << points_.size() << "\n";
    for (std::size_t n = 0; n < points_.size(); ++n) out << n + 1 << " " << points_[n].transpose() << "\n";
    out << "$EndNodes\n$Elements\n" << cells_.size() << "\n";
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      out << c + 1 << " " << corners_ - 1 << " 2 " << cells_[c].group << " " << cells_[c].group;
      for (const int n : cells_[c].nodes) out << " " << n;
      out << "\n";
    }
    out << "$EndElements\n";
    return path(name);
  }

  std::string stl(const std::string& name, bool binary) const
  {
    std::ofstream out(path(name), std::ios::binary);
    const auto point = [&](int n) { return points_[static_cast<std::size_t>(n) - 1]; };
    if (binary) {
      out << std::string("solid, but no text").append(80 - 18, ' ');
      const auto put = [&](const auto value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
      put(static_cast<std::uint32_t>(cells_.size()));
      for (const auto& cell : cells_) {
        for (int i = 0; i < 3; ++i) put(0.0F);
        for (const int n : cell.nodes)
          for (int i = 0; i < 3; ++i) put(static_cast<float>(point(n)[i]));
        put(std::uint16_t{0});
      }
      return path(name);
    }
    for (std::size_t g = 0; g < names_.size(); ++g) {
      out << "solid " << names_[g] << "\n";
      for (const auto& cell : cells_) {
        if (cell.group != static_cast<int>(g) + 1) continue;
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int n : cell.nodes) out << "vertex " << point(n).transpose() << "\n";
        out << "endloop\nendfacet\n";
      }
      out << "endsolid " << names_[g] << "\n";
    }
    return path(name);
  }

 private:
  struct Cell {
    int group;
    std::vector<int> nodes;
  };
  int corners_;
  std::vector<std::string> names_;
  std::vector<Point> points_;
  std::vector<Cell> cells_;
};

using Surfaces = std::map<std::string, std::vector<std::string>>;

Assembly read_surfaces(const std::string& file, Surfaces surfaces, int dimension = 3)
{
  Options options;
  options.file = file;
  options.surfaces = std::move(surfaces);
  return read(options, dimension);
}

// What each body encloses: positive only if all normals point out.
std::vector<double> volumes(const Assembly& assembly)
{
  const auto& mesh = assembly.mesh;
  std::vector<double> result(assembly.catalogue.bodies.size(), 0.0);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    const auto x = [&](std::size_t k) { return mesh.points[static_cast<std::size_t>(nodes[k])]; };
    auto& volume = result[static_cast<std::size_t>(mesh.cell_body[c])];
    if (assembly.catalogue.dimension == 2) volume += (x(0)[0] * x(1)[1] - x(0)[1] * x(1)[0]) / 2;
    for (int k = 1; assembly.catalogue.dimension == 3 && k + 1 < corner_count(mesh.cells.type[c]); ++k)
      volume += x(0).dot(x(static_cast<std::size_t>(k)).cross(x(static_cast<std::size_t>(k) + 1))) / 6;
  }
  return result;
}

std::vector<std::string> bodies(const Assembly& assembly)
{
  std::vector<std::string> result;
  for (const auto& body : assembly.catalogue.bodies) result.push_back(body.name);
  return result;
}

std::size_t facets_of(const Assembly& assembly, const std::string& boundary)
{
  const auto& names = assembly.catalogue.boundaries;
  const auto at = std::find(names.begin(), names.end(), boundary) - names.begin();
  const auto& list = assembly.mesh.facets.boundary;
  return static_cast<std::size_t>(std::count(list.begin(), list.end(), static_cast<int>(at)));
}

std::string refusal(const Soup& soup, Surfaces surfaces = {{"a", {}}})
{
  try {
    read_surfaces(soup.msh("refused.msh"), std::move(surfaces));
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input) << error.what();
    return error.what();
  }
  return "";
}

const Point origin = Point::Zero();

TEST(ClosedSurfaces, AreTurnedOutward)
{
  Soup soup;
  soup.cube(soup.group("a"), {3, 2, 1}, 2);
  const auto assembly = read_surfaces(soup.msh("cube.msh"), {{"a", {}}});
  EXPECT_EQ(bodies(assembly), std::vector<std::string>{"a"});
  EXPECT_NEAR(volumes(assembly)[0], 8, 1e-12);
  EXPECT_EQ(assembly.mesh.node_count(), 8U);
  EXPECT_EQ(facets_of(assembly, "a"), 12U);
}

TEST(ClosedSurfaces, EncloseCavitiesAndWhatLiesInThem)
{
  Soup soup;
  const int a = soup.group("a"), b = soup.group("b");
  for (const double edge : {1.0, 4.0, 2.0}) soup.cube(a, origin, edge);  // a kernel, a shell's outside and inside
  soup.cube(a, {10, 0, 0}, 3);
  soup.cube(a, {10, 0, 0}, 1);
  soup.cube(b, {10, 0, 0}, 0.5);  // of another body: no kernel of the first one
  const auto assembly = read_surfaces(soup.msh("nested.msh"), {{"a", {}}, {"b", {}}});
  EXPECT_EQ(bodies(assembly), (std::vector<std::string>{"a.1", "a.2", "a.3", "b"}));
  const auto found = volumes(assembly);
  const double expected[] = {1, 64 - 8, 27 - 1, 0.125};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << i;
}

TEST(ClosedSurfaces, AreMadeOfSeveral)
{
  Soup soup;
  const int outer = soup.group("outer"), inner = soup.group("inner");
  soup.cube(outer, origin, 2);
  soup.cube(inner, origin, 1);
  const auto assembly = read_surfaces(soup.msh("several.msh"), {{"shell", {"outer", "inner"}}});
  EXPECT_EQ(bodies(assembly), std::vector<std::string>{"shell"});
  EXPECT_NEAR(volumes(assembly)[0], 7, 1e-12);
  EXPECT_EQ(facets_of(assembly, "outer"), 12U);
  EXPECT_EQ(facets_of(assembly, "inner"), 12U);
}

TEST(ClosedSurfaces, OfPlaneModelsAreCurves)
{
  Soup soup(2);
  const int a = soup.group("a");
  soup.square(a, 0, 0, 3, true);
  soup.square(a, 1, 1, 1, false);
  const auto assembly = read_surfaces(soup.msh("curves.msh"), {{"a", {}}}, 2);
  EXPECT_EQ(bodies(assembly), std::vector<std::string>{"a"});
  EXPECT_NEAR(volumes(assembly)[0], 8, 1e-12);
}

TEST(ClosedSurfaces, MistakesAreExplained)
{
  Soup open;
  open.cube(open.group("a"), origin, 1);
  open.remove_last();
  EXPECT_NE(refusal(open).find("is not closed near (0.5, -0.5, 0): a cell there has no neighbour"), std::string::npos)
      << refusal(open);
  EXPECT_NE(refusal(open, {{"a", {"a", "b"}}}).find("there is no physical surface \"b\""), std::string::npos);
  EXPECT_NE(refusal(open, {}).find("method: boundary_elements"), std::string::npos);

  Soup crossing;
  const int a = crossing.group("a");
  crossing.cube(a, origin, 1);
  crossing.cube(a, {0.5, 0.1, 0.1}, 1);
  EXPECT_NE(refusal(crossing).find("crosses itself"), std::string::npos) << refusal(crossing);

  Soup twice;
  const int whole = twice.group("a");
  twice.cube(whole, origin, 1);
  twice.cell(whole, {1, 2, 4});
  EXPECT_NE(refusal(twice).find("meets itself"), std::string::npos) << refusal(twice);

  Soup flat;
  const int pillow = flat.group("a");
  for (const Point& x : {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)}) flat.node(x);
  flat.cell(pillow, {1, 2, 3});
  flat.cell(pillow, {1, 2, 3});
  EXPECT_NE(refusal(flat).find("encloses nothing"), std::string::npos) << refusal(flat);

  Soup projective;  // the projective plane of six nodes has no two sides
  const int plane = projective.group("a");
  for (int k = 0; k < 6; ++k) projective.node({std::cos(k), std::sin(2.0 * k), 0.3 * k * k});
  const int triangles[10][3] = {{1, 2, 3}, {1, 3, 4}, {1, 4, 5}, {1, 5, 6}, {1, 6, 2},
                                {2, 3, 5}, {3, 4, 6}, {4, 5, 2}, {5, 6, 3}, {6, 2, 4}};
  for (const auto& t : triangles) projective.cell(plane, {t[0], t[1], t[2]});
  EXPECT_NE(refusal(projective).find("has one side only"), std::string::npos) << refusal(projective);
}

TEST(ClosedSurfaces, OfStlFiles)
{
  Soup soup;
  soup.cube(soup.group("first one"), origin, 2);
  soup.cube(soup.group("second"), {5, 0, 0}, 1);
  const auto both = read_surfaces(soup.stl("two.stl", false), {{"first one", {}}, {"second", {}}});
  EXPECT_EQ(bodies(both), (std::vector<std::string>{"first one", "second"}));
  EXPECT_NEAR(volumes(both)[0], 8, 1e-6);
  EXPECT_NEAR(volumes(both)[1], 1, 1e-6);
  Soup one;
  one.cube(one.group("program"), origin, 2);
  for (const bool binary : {false, true}) {
    const auto assembly = read_surfaces(one.stl("part.stl", binary), {{"part", {}}});
    EXPECT_EQ(bodies(assembly), std::vector<std::string>{"part"});
    EXPECT_NEAR(volumes(assembly)[0], 8, 1e-6);
    EXPECT_EQ(facets_of(assembly, "part"), 12U);
    std::filesystem::resize_file(path("part.stl"), std::filesystem::file_size(path("part.stl")) - 60);
    EXPECT_THROW(read_surfaces(path("part.stl"), {{"part", {}}}), Error);
  }
}

// Two boxes, one of them hollow, by gmsh.
const char* const boxes = R"(
SetFactory("OpenCASCADE");
DefineConstant[ volumes = 0, order = 1, quads = 0 ];
Box(1) = {0, 0, 0, 3, 3, 3};
Box(2) = {1, 1, 1, 1, 1, 1};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(4) = {5, 0, 0, 1, 1, 1};
Mesh.MeshSizeMax = 1; Mesh.ElementOrder = order;
If (quads)
  Transfinite Curve {:} = 3; Transfinite Surface {:}; Recombine Surface {:};
EndIf
all() = Boundary { Volume{3}; };
Physical Volume("solid") = {4};
Physical Surface("hollow") = all();
Physical Surface("side") = Surface In BoundingBox {-0.1, -0.1, -0.1, 0.1, 3.1, 3.1};
If (volumes)
  Physical Volume("hollow") = {3};
EndIf
)";

Assembly read_boxes(std::map<std::string, double> constants, Surfaces surfaces, std::optional<int> dimension)
{
  std::ofstream(path("boxes.geo")) << boxes;
  Options options;
  options.file = path("boxes.geo");
  options.constants = std::move(constants);
  options.surfaces = std::move(surfaces);
  options.dimension = dimension;
  return read(options, 3);
}

TEST(ClosedSurfaces, OfGeometriesStandBesideVolumes)
{
  const auto mixed = read_boxes({}, {{"hollow", {}}}, {});
  EXPECT_EQ(bodies(mixed), (std::vector<std::string>{"solid", "hollow"}));
  EXPECT_EQ(dimension(mixed.mesh.cells.type.front()), 3);
  EXPECT_EQ(dimension(mixed.mesh.cells.type.back()), 2);
  EXPECT_NEAR(volumes(mixed)[1], 26, 1e-9);
  EXPECT_GT(facets_of(mixed, "side"), 0U);
  EXPECT_GT(facets_of(mixed, "hollow"), facets_of(mixed, "side"));

  // Volumes that have no cells, all of them, of first and second order, with quadrilaterals.
  const std::map<std::string, double> variants[] = {{{"volumes", 1}},
                                                    {{"volumes", 1}, {"order", 2}},
                                                    {{"volumes", 1}, {"quads", 1}},
                                                    {{"volumes", 1}, {"quads", 1}, {"order", 2}}};
  for (const auto& constants : variants) {
    const auto skins = read_boxes(constants, {{"hollow", {}}, {"solid", {}}}, 2);
    EXPECT_EQ(bodies(skins), (std::vector<std::string>{"solid", "hollow"}));
    EXPECT_NEAR(volumes(skins)[0], 1, 1e-9);
    EXPECT_NEAR(volumes(skins)[1], 26, 1e-9);
    EXPECT_EQ(skins.mesh.cells.type[0] != first_order(skins.mesh.cells.type[0]), constants.contains("order"));
    EXPECT_EQ(corner_count(skins.mesh.cells.type[0]), constants.contains("quads") ? 4 : 3);
  }

  // Cells of the body are there: they are taken.
  const auto solid = read_boxes({{"volumes", 1}}, {{"hollow", {}}}, {});
  EXPECT_EQ(dimension(solid.mesh.cells.type.back()), 3);
  EXPECT_THROW(read_boxes({{"volumes", 1}}, {{"hollow", {"hollow"}}}, {}), Error);
}

// A volume in the cavity of a body that has cells, all of its sides in a surface of the body's name: it is forgotten, not left
// out.
TEST(ClosedSurfaces, StandInForNoVolumeThatIsThere)
{
  std::ofstream(path("filled.geo")) << R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 3, 3, 3};
Box(2) = {1, 1, 1, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.MeshSizeMax = 1;
inner() = Boundary{ Volume{2}; };
Physical Volume("hollow") = {3};
Physical Surface("hollow") = {inner()};
)";
  EXPECT_THROW(read_surfaces(path("filled.geo"), {{"hollow", {}}}), Error);
}

}  // namespace
}  // namespace mortise::mesh
