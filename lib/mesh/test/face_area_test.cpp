#include "mesh/face_area.hpp"

#include <gtest/gtest.h>

namespace mortise::mesh {
namespace {

// In the plane x + y = 1, and an edge in the plane of x and y.
const std::vector<Point> points{{1, 0, 0}, {0, 1, 0}, {0, 1, 3}, {1, 0, 3}, {0.5, 0.5, 0}, {0, 1, 1.5}, {0.5, 0.5, 1.5}};

TEST(FaceArea, OfAnEdgeIsItsLengthToTheRight)
{
  EXPECT_EQ(area_vector(points, std::vector<Local>{0, 1}, CellType::line2), Point(1, 1, 0));
  EXPECT_EQ(area_vector(points, std::vector<Local>{0, 1, 4}, CellType::line3), Point(1, 1, 0));
}

TEST(FaceArea, OfATriangleOrQuadrilateralIsThatBetweenItsCorners)
{
  EXPECT_EQ(area_vector(points, std::vector<Local>{0, 1, 2}, CellType::tri3), Point(1.5, 1.5, 0));
  EXPECT_EQ(area_vector(points, std::vector<Local>{0, 1, 2, 4, 5, 6}, CellType::tri6), Point(1.5, 1.5, 0));
  EXPECT_EQ(area_vector(points, std::vector<Local>{0, 1, 2, 3}, CellType::quad4), Point(3, 3, 0));
  EXPECT_EQ(area_vector(points, std::vector<Local>{3, 2, 1, 0}, CellType::quad4), Point(-3, -3, 0));
}

}  // namespace
}  // namespace mortise::mesh
