// CAD files are written by gmsh's OpenCASCADE and read back.
#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <sstream>

#include "base/error.hpp"
#include "mesh/curved_surface.hpp"
#include "mesh/read.hpp"
#include "scratch.hpp"

namespace mortise::mesh {
namespace {

using test::path;

// Makes shapes and writes them.
template <class Make>
std::string cad(const std::string& name, const Make& make)
{
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  make();
  gmsh::model::occ::synchronize();
  gmsh::write(path(name));
  gmsh::finalize();
  return path(name);
}

void box_and_pin()
{
  gmsh::model::occ::addBox(0, 0, 0, 2, 1, 1);
  gmsh::model::occ::addCylinder(4, 0, 0, 0, 0, 1, 0.5);
}

// Gives the n-th part of the assembly in a STEP file a name in place of OpenCASCADE's own.
void rename(const std::string& file, int n, const std::string& name)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  const std::regex given("'Open CASCADE[^']* [0-9]+\\." + std::to_string(n) + "'");
  ASSERT_TRUE(std::regex_search(text.str(), given));
  std::ofstream(file) << std::regex_replace(text.str(), given, "'" + name + "'");
}

Options options(const std::string& file, double size)
{
  Options result;
  result.file = file;
  result.size.max = size;
  return result;
}

std::vector<std::string> names(const Assembly& assembly)
{
  std::vector<std::string> result;
  for (const auto& body : assembly.catalogue.bodies) result.push_back(body.name);
  return result;
}

// Area of the triangles of a boundary, by their corners.
double area(const Assembly& assembly, const std::string& boundary)
{
  const auto& all = assembly.catalogue.boundaries;
  const auto index = std::find(all.begin(), all.end(), boundary) - all.begin();
  const auto& mesh = assembly.mesh;
  double sum = 0;
  for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
    if (mesh.facets.boundary[f] != index) continue;
    const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(mesh.facets.cells[f][i])]; };
    sum += 0.5 * (p(1) - p(0)).cross(p(2) - p(0)).norm();
  }
  return sum;
}

TEST(Cad, SolidsAreBodiesAndFacesHaveNames)
{
  for (const char* name : {"plain.step", "plain.brep"}) {
    const auto assembly = read(options(cad(name, box_and_pin), 0.5), 3);
    EXPECT_EQ(names(assembly), (std::vector<std::string>{"solid.1", "solid.2"})) << name;
    std::vector<double> areas;
    for (int k = 1; k <= 6; ++k) areas.push_back(area(assembly, "solid.1.face." + std::to_string(k)));
    std::sort(areas.begin(), areas.end());
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(areas[static_cast<std::size_t>(k)], k < 2 ? 1 : 2, 1e-12) << name;
    double whole = 0;
    for (int k = 1; k <= 3; ++k) whole += area(assembly, "solid.2.face." + std::to_string(k));
    EXPECT_NEAR(whole, 1.5 * std::numbers::pi, 0.1 * whole);  // as far as flat triangles can
    EXPECT_EQ(std::count_if(assembly.catalogue.boundaries.begin(), assembly.catalogue.boundaries.end(),
                            [](const auto& boundary) { return !curved_surface(boundary); }),
              9);
  }
}

// All curved surfaces of an assembly that have faces, with the number of these.
std::vector<std::pair<CurvedSurface, int>> curved(const Assembly& assembly)
{
  std::vector<std::pair<CurvedSurface, int>> result;
  for (std::size_t b = 0; b < assembly.catalogue.boundaries.size(); ++b) {
    const auto surface = curved_surface(assembly.catalogue.boundaries[b]);
    if (!surface) continue;
    const auto& boundary = assembly.mesh.facets.boundary;
    const auto count = std::count(boundary.begin(), boundary.end(), static_cast<int>(b));
    const auto known = std::find_if(result.begin(), result.end(), [&](const auto& s) { return same(s.first, *surface); });
    if (known == result.end())
      result.emplace_back(*surface, static_cast<int>(count));
    else
      known->second += static_cast<int>(count);
  }
  return result;
}

// A pin in a hole, both in halves; a taper pin; a ball; and what is neither: a ring, an elliptic bar.
TEST(Cad, CurvedSurfacesAreKnown)
{
  const auto make = [] {
    namespace occ = gmsh::model::occ;
    const int plate = occ::addBox(-3, -3, 0, 6, 6, 1), hole = occ::addCylinder(0, 0, -1, 0, 0, 3, 1);
    gmsh::vectorpair cut;
    std::vector<gmsh::vectorpair> map;
    occ::cut({{3, plate}}, {{3, hole}}, cut, map);
    occ::addCylinder(0, 0, -0.5, 0, 0, 2, 1, -1, std::numbers::pi);
    occ::addCone(10, 0, 0, 0, 2, 0, 1, 0.5);
    occ::addSphere(20, 0, 0, 2);
    occ::addTorus(30, 0, 0, 2, 0.5);
    const int ellipse = occ::addPlaneSurface({occ::addCurveLoop({occ::addEllipse(40, 0, 0, 2, 1)})});
    gmsh::vectorpair bar;
    occ::extrude({{2, ellipse}}, 0, 0, 1, bar);
  };
  for (const char* name : {"curved.step", "curved.brep"}) {
    auto input = options(cad(name, make), 0.7);
    input.scale = 2;
    const auto found = curved(read(input, 3));
    const auto count = [&](const CurvedSurface& wanted) {
      const auto at = std::find_if(found.begin(), found.end(), [&](const auto& s) { return same(s.first, wanted); });
      return at == found.end() ? 0 : at->second;
    };
    EXPECT_EQ(found.size(), 3U) << name;
    EXPECT_GT(count({{0, 0, 7}, {0, 0, 1}, 2, 0}), 40) << name;  // hole and half pin
    EXPECT_GT(count({{20, 0, 0}, {0, 1, 0}, 2, -0.25}), 10) << name;
    EXPECT_GT(count({{40, 0, 0}, Point::Zero(), 4, 0}), 40) << name;
  }
}

TEST(Cad, CirclesAreKnownInThePlane)
{
  const auto make = [] {
    namespace occ = gmsh::model::occ;
    occ::addDisk(0, 0, 0, 1, 1);
    occ::addDisk(5, 0, 0, 2, 1);  // an ellipse
    occ::addRectangle(10, 0, 0, 1, 1);
  };
  const auto found = curved(read(options(cad("disks.step", make), 0.3), 2));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(same(found[0].first, {Point::Zero(), Point::UnitZ(), 1, 0}));
  EXPECT_GT(found[0].second, 10);
}

TEST(Cad, LabelsOfStepFiles)
{
  const auto file = cad("named.step", box_and_pin);
  rename(file, 1, "plate:upper");
  rename(file, 2, "pin");
  const auto assembly = read(options(file, 0.5), 3);
  EXPECT_EQ(names(assembly), (std::vector<std::string>{"pin", "plate_upper"}));
  EXPECT_GT(area(assembly, "plate_upper.face.1"), 0.9);
}

TEST(Cad, SolidsOfOneNameAreOneGroup)
{
  const auto file = cad("twins.step", box_and_pin);
  rename(file, 1, "roller");
  rename(file, 2, "roller");
  const auto assembly = read(options(file, 0.5), 3);
  EXPECT_EQ(names(assembly), (std::vector<std::string>{"roller.1", "roller.2"}));
  EXPECT_EQ(assembly.catalogue.bodies[1].group, "roller");
  EXPECT_GT(area(assembly, "roller.2.face.1"), 0.1);
}

TEST(Cad, SolidsThatShareAFaceStayApart)
{
  const auto file = cad("shared.brep", [] {
    gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
    gmsh::model::occ::addBox(1, 0, 0, 1, 1, 1);
    std::vector<std::pair<int, int>> out;
    std::vector<std::vector<std::pair<int, int>>> map;
    gmsh::model::occ::fragment({{3, 1}}, {{3, 2}}, out, map);
  });
  auto given = options(file, 0.6);
  const auto assembly = read(given, 3);
  EXPECT_EQ(names(assembly), (std::vector<std::string>{"solid.1", "solid.2"}));
  EXPECT_TRUE(assembly.warnings.empty());
  for (const char* solid : {"solid.1", "solid.2"}) {
    double whole = 0;
    for (int k = 1; k <= 6; ++k) whole += area(assembly, solid + std::string(".face.") + std::to_string(k));
    EXPECT_NEAR(whole, 6, 1e-12) << "the common face stands once for each";
  }
  given.volumes["bar"] = {"solid.1", "solid.2"};  // unless they are to be one body
  const auto united = read(given, 3);
  EXPECT_EQ(names(united), (std::vector<std::string>{"bar"}));
  EXPECT_LT(united.mesh.node_count(), assembly.mesh.node_count());
  EXPECT_EQ(united.mesh.cell_volume.size(), united.mesh.cells.size());
}

TEST(Cad, SizeOrderAndScale)
{
  const auto file = cad("sized.step", [] { gmsh::model::occ::addCylinder(0, 0, 0, 0, 0, 1, 1); });
  auto given = options(file, 10);
  given.scale = 10;  // sizes are those of the model
  given.size.curvature = 16;
  const auto assembly = read(given, 3);
  const auto whole = [](const Assembly& a) {
    return area(a, "solid.1.face.1") + area(a, "solid.1.face.2") + area(a, "solid.1.face.3");
  };
  // A prism over a regular polygon of 16 corners or more.
  const double a = std::numbers::pi / 16, inscribed = 16 * std::sin(2 * a) + 32 * std::sin(a);
  EXPECT_GT(whole(assembly), 100 * inscribed * 0.999);
  EXPECT_LT(whole(assembly), 100 * 4 * std::numbers::pi);
  given.size.max = 1.5;
  EXPECT_GT(read(given, 3).mesh.cells.size(), 3 * assembly.mesh.cells.size());
  given.size.max = 10;
  given.order = 2;
  const auto curved = read(given, 3);
  EXPECT_EQ(curved.mesh.cells.type[0], CellType::tet10);
  double farthest = 0;
  for (const auto& x : curved.mesh.points) farthest = std::max(farthest, x.head<2>().norm());
  EXPECT_NEAR(farthest, 10, 1e-9);
}

TEST(Cad, PlaneModels)
{
  const auto file = cad("plane.step", [] {
    gmsh::model::occ::addRectangle(0, 0, 0, 2, 1);
    gmsh::model::occ::addDisk(4, 0, 0, 1, 1);
  });
  const auto assembly = read(options(file, 0.5), 2);
  EXPECT_EQ(names(assembly), (std::vector<std::string>{"surface.1", "surface.2"}));
  EXPECT_TRUE(std::find(assembly.catalogue.boundaries.begin(), assembly.catalogue.boundaries.end(), "surface.1.edge.4") !=
              assembly.catalogue.boundaries.end());
}

TEST(Cad, NoSolidsIsAnError)
{
  const auto file = cad("flat.step", [] { gmsh::model::occ::addRectangle(0, 0, 0, 2, 1); });
  EXPECT_THROW(read(options(file, 0.5), 3), Error);
}

}  // namespace
}  // namespace mortise::mesh
