// Files that are damaged, that are not what they are called, or that would do more than describe a mesh.
#include <gmsh.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include "base/error.hpp"
#include "mesh/blocks.hpp"
#include "mesh/extent.hpp"
#include "mesh/read.hpp"
#include "scratch.hpp"

namespace mortise::mesh {
namespace {

using test::path;

std::string write(const std::string& name, const std::string& text)
{
  std::ofstream(path(name)) << text;
  return path(name);
}

Options options(const std::string& file)
{
  Options result;
  result.file = file;
  result.time_limit = 60;
  return result;
}

// What reading says; "" if it succeeds.
std::string said(const Options& options, int dimension = 3)
{
  try {
    read(options, dimension);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind(options.file, 0), 0U) << error.what();
    return error.what();
  }
  return "";
}

#define EXPECT_SAID(options, words) EXPECT_NE(said(options).find(words), std::string::npos) << said(options)

const std::string box = "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\nPhysical Volume(\"a\") = {1};\n";

// A brick in the format 4.1; `coordinate`: of its last node, `node`: the last one of the cell.
std::string brick(const std::string& coordinate = "1", const std::string& node = "8")
{
  return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"a\"\n$EndPhysicalNames\n$Entities\n0 0 0 1\n"
         "1 0 0 0 1 1 1 1 1 0\n$EndEntities\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n"
         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 " +
         coordinate + "\n$EndNodes\n$Elements\n1 1 1 1\n3 1 5 1\n1 1 2 3 4 5 6 7 " + node + "\n$EndElements\n";
}

TEST(FaultyFiles, NoMeshFileIsAScript)
{
  const auto trace = path("trace");
  const std::string script = "SystemCall \"touch " + trace + "\";\n" + box;
  EXPECT_SAID(options(write("evil.msh", script)), "$MeshFormat");
  EXPECT_SAID(options(write("late.msh", script + brick())), "$MeshFormat");
  EXPECT_SAID(options(write("evil.step", script)), "ISO-10303-21");
  EXPECT_SAID(options(write("evil.brep", script)), "CASCADE Topology");
  EXPECT_SAID(options(write("evil.unknown", script)), "expected .msh");
  EXPECT_SAID(options(write("evil", script)), "expected .msh");
  EXPECT_NE(said(options(write("evil.inp", script))), "");
  EXPECT_NE(said(options(write("then.msh", "$MeshFormat\n" + script))), "");
  write("aside.msh.opt", script);  // gmsh looks for options beside some files
  said(options(write("aside.msh", brick())));
  EXPECT_FALSE(std::filesystem::exists(trace));
}

TEST(FaultyFiles, ScriptsOnlyDescribeUnlessAllowed)
{
  const auto trace = path("trace_of_script");
  for (const std::string& line : {"SystemCall \"touch " + trace + "\";\n", "Printf(\"x\") > \"" + trace + "\";\n",
                                  "Mesh 3; Save \"" + trace + ".msh\";\n"}) {
    auto given = options(write("script.geo", box + line));
    EXPECT_SAID(given, "--allow-scripts");
    EXPECT_FALSE(std::filesystem::exists(trace) || std::filesystem::exists(trace + ".msh")) << line;
    given.allow_scripts = true;
    EXPECT_EQ(said(given), "");
    EXPECT_TRUE(std::filesystem::remove(trace) || std::filesystem::remove(trace + ".msh")) << line;
  }
  EXPECT_EQ(said(options(write("outer.geo", "Include \"" + write("inner.geo", box) + "\";\n"))), "");  // reading is no harm
}

TEST(FaultyFiles, CausesAreKept)
{
  EXPECT_SAID(options(write("syntax.geo", "Point(1) = {0, 0, 0}\n\nPhysical Volume(\"a\") = {1};\n")), "line 3");
  EXPECT_SAID(options(write("unknown.msh", brick("1", "99"))), "99");
  EXPECT_NE(said(options(write("negative.msh", brick("1", "-1")))), "");  // gmsh crashes
  EXPECT_SAID(options(std::filesystem::path(path("x")).parent_path().string()), "is a directory");
  EXPECT_SAID(options(write("empty.msh", "")), "is empty");
  EXPECT_EQ(said(options(write("whole.msh", brick()))), "");
}

// gmsh itself would read this without its last element.
TEST(FaultyFiles, LinesTooManyAreNotLost)
{
  const std::string cells[2] = {"1 5 2 1 1 1 2 3 4 5 6 7 8\n", "2 5 2 1 1 5 6 7 8 9 10 11 12\n"};
  const auto two = [&](const std::string& between) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"a\"\n$EndPhysicalNames\n$Nodes\n12\n"
           "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 0 0 2\n10 1 0 2\n11 1 1 2\n12 0 1 2\n"
           "$EndNodes\n$Elements\n2\n" +
           cells[0] + between + cells[1] + "$EndElements\n";
  };
  EXPECT_EQ(said(options(write("two.msh", two("")))), "");
  EXPECT_SAID(options(write("two.msh", two(cells[0]))), "line 24: $Elements is to have 2 lines after this one, and has 3");
  auto more = brick();
  more.insert(more.find("$EndElements"), "2 1 2 3 4 5 6 7 8\n");
  EXPECT_SAID(options(write("more.msh", more)), "$Elements is to have 2 lines");
}

TEST(FaultyFiles, NothingIsEndless)
{
  EXPECT_SAID(options(write("self.geo", box + "Macro f\nCall f;\nReturn\nCall f;\n")), "line 5: the macro \"f\" calls itself");
  EXPECT_SAID(options(write("pair.geo", box + "Macro f\nCall g;\nReturn\nMacro g\n/* Call h; */ Call f;\nReturn\nCall f;\n")),
              "calls itself");
  EXPECT_EQ(said(options(write("ends.geo", "n = 0;\nMacro f\nn = n + 1;\nIf (n < 3)\nCall f;\nEndIf\nReturn\nCall f;\n" + box))),
            "");
  auto loop = options(write("loop.geo", "For i In {1:1000000000}\nx = i;\nEndFor\n" + box));
  loop.time_limit = 0.5;
  EXPECT_SAID(loop, "within 0.5 seconds; mesh.time_limit");
}

TEST(FaultyFiles, CadFilesThatAreCutOff)
{
  for (const std::string name : {"part.brep", "part.step"}) {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
    gmsh::model::occ::synchronize();
    gmsh::write(path(name));
    gmsh::finalize();
    EXPECT_EQ(said(options(path(name))), "");
    const auto size = std::filesystem::file_size(path(name));
    for (const double part : {0.3, 0.7, 0.97}) {
      std::filesystem::resize_file(path(name), static_cast<std::size_t>(part * static_cast<double>(size)));
      EXPECT_SAID(options(path(name)), "is cut off");
    }
  }
}

TEST(FaultyFiles, CoordinatesAreNumbers)
{
  for (const char* x : {"nan", "inf", "-inf", "1e999"}) {
    EXPECT_SAID(options(write("x.msh", brick(x))), "node 8 has the coordinates \"");
    EXPECT_SAID(options(write("x.inp", std::string("*NODE\n1, 0, 0, 0\n2, 0, ") + x + ", 0\n")), "x.inp:3: expected a");
  }
  auto scaled = options(write("scaled.msh", brick("1e300")));
  EXPECT_SAID(scaled, "1e+300 long");
  scaled.scale = 1e10;
  EXPECT_SAID(scaled, "mesh.scale");
  scaled.file = write("scaled.msh", brick());
  scaled.scale = 1e-40;
  EXPECT_SAID(scaled, "1e-40 long");
}

// Throws what require_resolved says about a unit block of two cells an axis.
std::string resolved(double origin, double size, const Point& shift = Point::Zero())
{
  Options given;
  given.blocks["a"] = {{origin, 0, 0}, {size, size, size}, {2, 2, 2}, "hex8"};
  Layout layout;
  layout.catalogue.bodies.push_back({"a", "a"});
  layout.bodies.push_back({0, Motion{Eigen::Matrix3d::Identity(), shift}, 0, 0, {}});
  try {
    require_resolved(layout, block_extents(given, 3), "mesh.blocks");
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    return error.what();
  }
  return "";
}

TEST(Extent, CoordinatesMustTellNodesApart)
{
  EXPECT_EQ(resolved(0, 1), "");
  EXPECT_EQ(resolved(1e9, 1), "");
  EXPECT_EQ(resolved(0, 1e20), "");
  EXPECT_EQ(resolved(0, 1e-20), "");
  EXPECT_NE(resolved(1e11, 1).find("move the model nearer"), std::string::npos);
  EXPECT_NE(resolved(0, 1, {0, 1e15, 0}).find("move the model nearer"), std::string::npos);
  EXPECT_NE(resolved(0, 1e78).find("another unit of length"), std::string::npos);
  EXPECT_NE(resolved(0, 1e-82).find("another unit of length"), std::string::npos);
  EXPECT_NE(resolved(1e308, 1e308).find("no finite numbers"), std::string::npos);
  EXPECT_NE(resolved(0, 1, {HUGE_VAL, 0, 0}).find("no finite numbers"), std::string::npos);
  EXPECT_NE(resolved(std::numeric_limits<double>::quiet_NaN(), 1).find("no finite numbers"), std::string::npos);
}

TEST(Extent, BlocksMustHaveRoom)
{
  Options given;
  given.blocks["a"] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, "hex8"};
  EXPECT_NO_THROW(require_room(given, 3, true));
  given.blocks["a"].cells = {20000, 20000, 20000};
  EXPECT_NO_THROW(require_room(given, 3, false));  // pieces of a grid may fit
  EXPECT_THROW(require_room(given, 3, true), Error);
  EXPECT_THROW(require_room(block_catalogue(given, 3), 2), Error);
  EXPECT_NO_THROW(require_room(block_catalogue(given, 3), 1000000));
  given.blocks["a"].cells = {2000000000, 2000000000, 2000000000};
  EXPECT_THROW(require_room(given, 3, false), Error);  // numbers would overflow
}

// A square in the format 2.2 with the elements of its borders, "physical tag, elementary tag, nodes".
std::string square(const std::string& left, const std::string& right)
{
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 2 \"left\"\n1 3 \"right\"\n2 1 \"a\"\n$EndPhysicalNames\n"
         "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n1 1 2 " +
         left + "\n2 1 2 " + right + "\n3 3 2 1 1 1 2 3 4\n$EndElements\n";
}

TEST(FaultyFiles, GroupsThatShareAnElementaryTag)
{
  const auto two = options(write("two_tags.msh", square("2 1 4 1", "3 2 2 3")));
  EXPECT_EQ(said(two, 2), "");
  const auto shared = options(write("one_tag.msh", square("2 1 4 1", "3 1 2 3")));
  EXPECT_NE(said(shared, 2).find("physical groups 2 and 3 have the same elementary tag 1"), std::string::npos) << said(shared, 2);
  const auto both = options(write("both_groups.msh", square("2 1 4 1", "3 1 4 1")));
  EXPECT_EQ(said(both, 2), "");
}

TEST(FaultyFiles, GroupsThatShareAnElementaryTagInBinary)
{
  for (const int right : {1, 2}) {
    std::ofstream file(path("tags_binary.msh"), std::ios::binary);
    const auto put = [&](const std::vector<int>& values) {
      file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(int)));
    };
    file << "$MeshFormat\n2.2 1 8\n";
    put({1});
    file << "\n$EndMeshFormat\n$Nodes\n4\n";
    const double points[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (int n = 0; n < 4; ++n) {
      put({n + 1});
      file.write(reinterpret_cast<const char*>(points[n]), sizeof(points[n]));
    }
    file << "\n$EndNodes\n$Elements\n3\n";
    put({1, 2, 2, 1, 2, 1, 4, 1, 2, 3, right, 2, 3});
    put({3, 1, 2, 3, 1, 1, 1, 2, 3, 4});
    file << "\n$EndElements\n";
    file.close();
    const auto words = said(options(path("tags_binary.msh")), 2);
    if (right == 1)
      EXPECT_NE(words.find("have the same elementary tag 1"), std::string::npos) << words;
    else
      EXPECT_EQ(words.find("have the same elementary tag"), std::string::npos) << words;
  }
}

TEST(Constants, ThatTheGeometryGivesAnotherValueAreRefused)
{
  const auto with = [](const std::string& head) {
    auto result = options(write("constants.geo", head + "\n" + box + "MeshSize{:} = h;\n"));
    result.constants = {{"h", 0.4}};
    return result;
  };
  const std::string refused = "gives \"h\" a value of its own, whatever mesh.constants.h says";
  EXPECT_SAID(with("h = 0.5;"), "line 1: " + refused);
  EXPECT_SAID(with("// h\nn = 3; h= 0.5;"), "line 2: " + refused);
  EXPECT_SAID(with("h = DefineNumber[0.5, Min 0.1];"), refused);
  EXPECT_SAID(with("h = DefineNumber[0.5, Name \"h\"];"), refused);  // a name for ONELAB, which is not asked
  for (const char* head : {"DefineConstant[ h = 0.5 ];", "DefineConstant[ n = {3, Name \"n\"}, h = {0.5, Min 0.1} ];",
                           "If (!Exists(h))\n h = 0.5;\nEndIf", "size = h; h = size / 2;", "If (h == 3)\n h = 0.5;\nEndIf",
                           "n = 2; h *= n;", "", "DefineConstant[ h ]; h = 0.5;"})
    EXPECT_EQ(said(with(head)), "") << head;
}

}  // namespace
}  // namespace mortise::mesh
