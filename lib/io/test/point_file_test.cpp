#include "io/point_file.hpp"

#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;

TEST(PointFile, HasAPointALine)
{
  const Communicator comm;
  const Scratch scratch(comm);
  put(scratch / "points.csv", "x, y, z\n1, 2, 3\n\n# a comment\n-1e3;+2.5;0\r\n4 5 6 # the last", comm);
  const auto points = read_points(scratch / "points.csv", 3, comm);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].at, Point(1, 2, 3));
  EXPECT_EQ(points[1].at, Point(-1000, 2.5, 0));
  EXPECT_EQ(points[2].at, Point(4, 5, 6));
  EXPECT_EQ(points[0].line, 2);
  EXPECT_EQ(points[2].line, 6);
  put(scratch / "plane.csv", "1 2\n3 4 0\n", comm);
  EXPECT_EQ(read_points(scratch / "plane.csv", 2, comm).at(1).at, Point(3, 4, 0));
}

TEST(PointFile, SaysWhichLineIsNoPoint)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const auto complaint = [&](const std::string& text, int dimension) -> std::string {
    put(scratch / "points.csv", text, comm);
    try {
      read_points(scratch / "points.csv", dimension, comm);
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::bad_input);
      return error.what();
    }
    return "";
  };
  const auto expect = [&](const std::string& text, int dimension, const std::string& expected) {
    const auto found = complaint(text, dimension);
    EXPECT_NE(found.find(expected), std::string::npos) << found;
  };
  expect("1 2 3\n1 2\n", 3, "points.csv:2: expected three numbers, x, y, z, found \"1 2\"");
  expect("1 2 3\n1 2 z\n", 3, "points.csv:2: expected three numbers");
  expect("1 2 3 4\n", 3, "points.csv:1: expected three numbers");
  expect("1 2 inf\n", 3, "points.csv:1: expected three numbers");
  expect("1 2 3\n", 2, "points.csv:1: expected two numbers");
  expect("x,y,z\n", 3, "holds no points");
  try {
    read_points(scratch / "absent.csv", 3, comm);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("absent.csv cannot be read: No such file"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace mortise::io
