#include "io/nodal_field.hpp"

#include <fmt/format.h>

#include <random>

#include "io/cell_field.hpp"
#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;

double linear(const Point& x)
{
  return 20 + 3 * x[0] - 2 * x[1] + 0.5 * x[2];
}

// A unit cube of one hexahedron beside another one, values at the corners.
std::string two_cubes(const std::function<double(const Point&)>& value)
{
  std::string points, values;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k) {
        points += fmt::format("{} {} {}\n", i, j, k);
        values += fmt::format("{}\n", value(Point(i, j, k)));
      }
  return fmt::format(R"(<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="12" NumberOfCells="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{}</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 4 6 2 1 5 7 3 4 8 10 6 5 9 11 7</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8 16</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">12 12</DataArray></Cells>
<PointData><DataArray type="Float64" Name="T" format="ascii">{}</DataArray>
<DataArray type="Float64" Name="flux" NumberOfComponents="3" format="ascii">{}</DataArray></PointData>
<CellData><DataArray type="Float64" Name="source" format="ascii">1 2</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>)",
                     points, values, points);
}

TEST(NodalField, IsThatOfTheCellsOfAnotherMesh)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const auto product = [](const Point& x) { return 5 + x[0] * x[1] * x[2]; };  // what hexahedra hold exactly, in each
  put(scratch / "heat.vtu", two_cubes(product), comm);
  const NodalField field(scratch / "heat.vtu", "", 3, comm);
  EXPECT_EQ(field.size(), 12U);
  EXPECT_EQ(field.name(), "T");
  for (const Point& x : {Point(0.3, 0.2, 0.9), Point(1, 0.5, 0.5), Point(1.7, 0.4, 0.1), Point(0, 0, 0), Point(2, 1, 1)})
    EXPECT_NEAR(field(x), product(x), 1e-9) << x.transpose();
  EXPECT_NEAR(field(Point(2.1, 0.5, 0.5)), product(Point(2, 0.5, 0.5)), 1e-9);  // beside it, as on its skin
  EXPECT_THROW(field(Point(4, 0.5, 0.5)), Error);
  EXPECT_EQ(field.outside(Point(2.1, 0.5, 0.5)), 0);  // less than a tenth of the cell's diagonal
  EXPECT_NEAR(field.outside(Point(2.3, 0.5, 0.5)), 0.3, 1e-9);
  EXPECT_EQ(field.outside(Point(1, 0.5, 0.5)), 0);
}

// Of a face of second order VTK says that a place beside it, in its plane, lies in it.
TEST(CellField, KnowsWhatLiesBesideAFace)
{
  using enum mesh::CellType;
  for (const auto type : {quad4, quad8, quad9, tri3, tri6}) {
    CellArrays arrays;
    std::vector<Point> points{{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},    {0.5, 0, 0},
                              {1, 0.5, 0}, {0.5, 1, 0}, {0, 0.5, 0}, {0.5, 0.5, 0}};
    if (mesh::first_order(type) == tri3) points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}};
    points.resize(static_cast<std::size_t>(mesh::node_count(type)));
    std::vector<double> values;
    for (const auto& p : points) values.push_back(linear(p));
    arrays.add(points, values, type);
    const CellField field(arrays);
    const auto inside = field.nearest(Point(0.25, 0.3, 0));
    EXPECT_NEAR(inside.distance, 0, 1e-9) << mesh::name(type);
    EXPECT_NEAR(inside.value, linear(Point(0.25, 0.3, 0)), 1e-9);
    const auto above = field.nearest(Point(0.25, 0.3, 0.2));
    EXPECT_NEAR(above.distance, 0.2, 1e-9);
    EXPECT_NEAR(above.value, linear(Point(0.25, 0.3, 0)), 1e-9);
    const auto beside = field.nearest(Point(-0.25, 0.3, 0));
    EXPECT_GE(beside.distance, 0.25 - 1e-9) << mesh::name(type);
    EXPECT_LE(beside.distance, 0.4);
    EXPECT_NEAR(beside.value, linear(beside.at), 1e-9);
  }
}

TEST(NodalField, IsExactForLinearFieldsAmongPoints)
{
  const Communicator comm;
  const Scratch scratch(comm);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::string text = "\"Points:0\",\"Points:1\",\"Points:2\",\"T\",\"other\"\n";
  for (int i = 0; i < 400; ++i) {
    const Point x(2 * unit(random), unit(random), unit(random));
    text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},7\n", x[0], x[1], x[2], linear(x));
  }
  put(scratch / "heat.csv", text + "0.5,0.25,0.125,99,7\n", comm);
  const NodalField field(scratch / "heat.csv", "T", 3, comm);
  EXPECT_NEAR(field(Point(0.5, 0.25, 0.125)), 99, 1e-9);  // what the file says there
  for (int i = 0; i < 50; ++i) {
    const Point x(1 + unit(random), unit(random), unit(random));
    EXPECT_NEAR(field(x), linear(x), 1e-9);
  }
  EXPECT_THROW(field(Point(9, 0, 0)), Error);
}

TEST(NodalField, ConvergesWithTheDistanceOfThePoints)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const auto wave = [](const Point& x) { return std::sin(3 * x[0]) * std::cos(2 * x[1]); };
  double before = 0;
  for (const int n : {10, 20, 40}) {
    std::string text = "x;y;temperature\n";
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        text +=
            fmt::format("{:.17g};{:.17g};{:.17g}\n", double(i) / n, double(j) / n, wave(Point(double(i) / n, double(j) / n, 0)));
    put(scratch / "heat.csv", text, comm);
    const NodalField field(scratch / "heat.csv", "", 2, comm);
    double worst = 0;
    for (int i = 0; i <= 50; ++i)
      for (int j = 0; j <= 50; ++j) {
        const Point x(i / 50.0, j / 50.0, 0);
        worst = std::max(worst, std::abs(field(x) - wave(x)));
      }
    if (before > 0) {
      EXPECT_LT(worst, before / 3) << n;
    }
    before = worst;
  }
  EXPECT_LT(before, 2e-3);
  EXPECT_GT(before, 0);
}

TEST(NodalField, TakesPointsOfALineOrAPlaneAsTheyAre)
{
  const Communicator comm;
  const Scratch scratch(comm);
  put(scratch / "plane.csv", "x,y,z,T\n0,0,0,0\n1,0,0,1\n0,1,0,2\n1,1,0,3\n2,0,0,2\n", comm);
  const NodalField field(scratch / "plane.csv", "", 3, comm);
  EXPECT_NEAR(field(Point(0.5, 0.5, 0)), 1.5, 1e-12);
  EXPECT_NEAR(field(Point(0.5, 0.5, 0.2)), 1.5, 1e-12);  // across the plane nothing changes
  EXPECT_EQ(field.outside(Point(0.5, 0.5, 0.1)), 0);
  EXPECT_NEAR(field.outside(Point(0.5, 0.5, 0.3)), 0.3, 1e-12);
  EXPECT_EQ(field.outside(Point(0.5, 0.5, 0)), 0);
}

TEST(NodalField, SaysWhatIsWrongWithAFile)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const auto expect = [&](const std::string& file, const std::string& text, const std::string& name,
                          const std::string& expected) {
    put(scratch / file, text, comm);
    try {
      const NodalField field(scratch / file, name, 3, comm);
      ADD_FAILURE() << expected;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::bad_input);
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  };
  expect("a.csv", "x,y,T\n0,0,1\n", "", "a.csv:1: expected a line of names with x, y, z and the field among them");
  expect("a.csv", "x,y,z,T\n0,0,0\n", "", "a.csv:2: expected 4 values");
  expect("a.csv", "x,y,z,T\n0,0,0,nan\n", "", "a.csv:2: expected 4 values");
  expect("a.csv", "x,y,z,T\n0,0,zero,1\n", "", "a.csv:2: expected 4 values");
  expect("a.csv", "x,y,z,T\n", "", "holds no points");
  expect("a.csv", "", "", "holds no points");
  expect("a.csv", "x,y,z,T\n0,0,0,1\n", "", "holds one point alone");
  expect("a.csv", "x,y,z,T,U\n0,0,0,1,1\n", "", "say with `field` which one is meant: \"T\", \"U\"");
  expect("a.csv", "x,y,z,T,U\n0,0,0,1,1\n", "V", "has no column \"V\"; it has \"T\", \"U\"");
  expect("a.txt", "x,y,z,T\n", "", "expected a .vtu or a .csv file");
  expect("a.vtu", "x,y,z,T\n", "", "is no .vtu file");
  expect("a.vtu", two_cubes(linear), "heat", "has no field of points with one component \"heat\"; it has \"T\"");
  expect("a.vtu", two_cubes(linear), "source", "\"source\" is a field of cells");
  expect("a.vtu", two_cubes([](const Point&) { return std::nan(""); }), "", "is no number");
  std::string broken = two_cubes(linear);
  broken.replace(broken.find("5 9 11 7"), 8, "5 9 99 7");
  expect("a.vtu", broken, "", "that is not there");
  try {
    const NodalField field(scratch / "absent.csv", "", 3, comm);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("absent.csv cannot be read: No such file"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace mortise::io
