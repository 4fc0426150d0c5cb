// Sections of boxes: their areas, and triangles of a given size.
#include "io/section.hpp"

#include <gtest/gtest.h>

#include <map>

#include "mesh/blocks.hpp"

namespace mortise::io {
namespace {

double area(const Section& section)
{
  double sum = 0;
  const auto at = [&](Local p) { return section.points[static_cast<std::size_t>(p)]; };
  for (const auto& t : section.triangles) sum += (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm() / 2;
  return sum;
}

class SectionOf : public testing::TestWithParam<const char*> {
 protected:
  // A box 2 x 1 x 1 of 4 x 3 x 2 cells.
  mesh::Mesh box() const
  {
    mesh::Options options;
    mesh::BlockOptions block;
    block.size = {2, 1, 1};
    block.cells = {4, 3, 2};
    block.element = GetParam();
    options.blocks["box"] = block;
    return mesh::generate(options, 3, 0, {0, 0, 0}, block.cells);
  }
};

std::vector<double> heights(const mesh::Mesh& mesh, const Point& origin, const Point& normal)
{
  std::vector<double> result;
  for (const auto& p : mesh.points) {
    const double height = normal.dot(p - origin);
    result.push_back(std::abs(height) < 1e-12 ? 0 : height);
  }
  return result;
}

TEST_P(SectionOf, HasTheAreaOfTheBox)
{
  const auto mesh = box();
  const struct {
    Point origin, normal;
    double area;
  } planes[] = {{{0, 0, 0.3}, {0, 0, 1}, 2},
                {{0, 0, 0.5}, {0, 0, 1}, 2},  // through nodes
                {{0, 0, 1}, {0, 0, 1}, 2},    // the end that lies above
                {{0.7, 0, 0}, {1, 0, 0}, 1},
                {{0, 0, 0}, {1, -1, 0}, std::sqrt(2.0)},  // askew, through nodes
                {{1, 0.5, 0.5}, {0.1, 0, 1}, std::hypot(1, 0.1) * 2},
                {{0, 0, 2}, {0, 0, 1}, 0}};
  for (const auto& plane : planes) {
    const auto section = cut(mesh.points, mesh.cells, heights(mesh, plane.origin, plane.normal));
    EXPECT_NEAR(area(section), plane.area, 1e-12) << plane.origin.transpose();
    for (const auto& p : section.points) EXPECT_NEAR(plane.normal.dot(p - plane.origin), 0, 1e-12);
    ASSERT_EQ(section.cell.size(), section.triangles.size());
    for (std::size_t t = 0; t < section.triangles.size(); ++t)
      for (const Local p : section.triangles[t]) {  // in the box round its cell
        const auto nodes = mesh.cells[static_cast<std::size_t>(section.cell[t])];
        Point low = mesh.points[static_cast<std::size_t>(nodes[0])], high = low;
        for (const Local n : nodes) {
          low = low.cwiseMin(mesh.points[static_cast<std::size_t>(n)]);
          high = high.cwiseMax(mesh.points[static_cast<std::size_t>(n)]);
        }
        const Point& x = section.points[static_cast<std::size_t>(p)];
        EXPECT_TRUE((x.array() > low.array() - 1e-12).all() && (x.array() < high.array() + 1e-12).all());
      }
  }
}

// Every edge is that of two triangles or lies at the box's surface, also after cells of different sizes were halved.
TEST_P(SectionOf, IsRefinedWithoutGaps)
{
  const auto mesh = box();
  for (const double size : {10.0, 0.3, 0.11}) {
    const auto section = refined(cut(mesh.points, mesh.cells, heights(mesh, {1, 0.5, 0.5}, {0.1, 0, 1})), size);
    EXPECT_NEAR(area(section), std::hypot(1, 0.1) * 2, 1e-12);
    std::map<std::pair<Local, Local>, int> edges;
    for (const auto& t : section.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Local a = t[k], b = t[(k + 1) % 3];
        ++edges[{std::min(a, b), std::max(a, b)}];
        EXPECT_LE((section.points[static_cast<std::size_t>(a)] - section.points[static_cast<std::size_t>(b)]).norm(), size);
      }
    for (const auto& [edge, count] : edges) {
      const Point middle =
          (section.points[static_cast<std::size_t>(edge.first)] + section.points[static_cast<std::size_t>(edge.second)]) / 2;
      const bool at_surface = std::min({middle[0], 2 - middle[0], middle[1], 1 - middle[1]}) < 1e-12;
      EXPECT_EQ(count, at_surface ? 1 : 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Types, SectionOf,
                         testing::Values("tet4", "hex8", "prism6", "tet10", "hex20", "hex27", "prism15", "prism18"),
                         [](const auto& info) { return std::string(info.param); });

// The surface of a box from `low`, with edges `size`, as triangles.
void add_box(const Point& low, const Point& size, bool outward, std::vector<Point>& points, mesh::Cells& triangles)
{
  const auto first = static_cast<Local>(points.size());
  for (int k = 0; k < 8; ++k) {
    Point x = low;
    for (int axis = 0; axis < 3; ++axis) x[axis] += (k >> axis & 1) * size[axis];
    points.push_back(x);
  }
  const Local sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& s : sides)
    for (const auto& [a, b] : {std::pair(1, 2), std::pair(2, 3)})
      triangles.add(mesh::CellType::tri3, std::vector{first + s[0], first + s[outward ? a : b], first + s[outward ? b : a]});
}

TEST(SectionOfSurfaces, HasTheAreaInside)
{
  std::vector<Point> points;
  mesh::Cells triangles;
  add_box({0, 0, 0}, {2, 1, 1}, true, points, triangles);
  add_box({0.5, 0.25, 0.25}, {1, 0.5, 0.5}, false, points, triangles);  // a cavity
  add_box({3, 0, 0}, {1, 1, 1}, true, points, triangles);
  const struct {
    Point origin, normal;
    double area;
  } planes[] = {{{0, 0, 0.3}, {0, 0, 1}, 2.5},
                {{0, 0, 0.1}, {0, 0, 1}, 3},
                {{0, 0, 0.25}, {0, 0, 1}, 3},  // through the bottom of the cavity, which counts as above
                {{0, 0, 1}, {0, 0, 1}, 3},
                {{0.7, 0, 0}, {-1, 0, 0}, 0.75},
                {{0, 0, 0.5}, {0, 0.1, 1}, 2.5 * std::hypot(1, 0.1)},
                {{0, 0, 2}, {0, 0, 1}, 0}};
  for (const auto& plane : planes) {
    std::vector<double> height;
    for (const auto& p : points) height.push_back(plane.normal.normalized().dot(p - plane.origin));
    const auto section = enclosed(points, triangles, height, plane.normal.normalized());
    EXPECT_NEAR(area(section), plane.area, 1e-12) << plane.origin.transpose() << ", " << plane.normal.transpose();
    for (const auto& p : section.points) EXPECT_NEAR(plane.normal.normalized().dot(p - plane.origin), 0, 1e-12);
    const auto fine = refined(section, 0.1);
    EXPECT_NEAR(area(fine), plane.area, 1e-12);
  }
}

}  // namespace
}  // namespace mortise::io
