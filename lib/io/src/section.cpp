#include "io/section.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkMergePoints.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>

#include "vtk_cells.hpp"

namespace mortise::io {

namespace {

// The cells that are cut alone, with all points.
vtkNew<vtkUnstructuredGrid> grid_of(const std::vector<Point>& points, const mesh::Cells& cells, const std::vector<Local>& chosen)
{
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (const auto& p : points) places->InsertNextPoint(p.data());
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(places);
  grid->Allocate(static_cast<vtkIdType>(chosen.size()));
  for (const Local c : chosen) {
    const auto type = cells.type[static_cast<std::size_t>(c)];
    const auto nodes = vtk_nodes(type, cells[static_cast<std::size_t>(c)]);
    grid->InsertNextCell(vtk_type(type), static_cast<vtkIdType>(nodes.size()), nodes.data());
  }
  return grid;
}

// A line of the plane by two coordinates, the end with the smaller second one first.
using Line = std::array<std::array<double, 2>, 2>;

// Where closed surfaces of triangles meet the plane; lines along the first direction are left out.
std::vector<Line> outline(const std::vector<Point>& points, const mesh::Cells& triangles, const std::vector<double>& height,
                          const Point& right, const Point& up)
{
  const auto crossing = [&](Local a, Local b) -> std::array<double, 2> {  // the same from both sides of an edge
    if (a > b) std::swap(a, b);
    const double of_a = height[static_cast<std::size_t>(a)], of_b = height[static_cast<std::size_t>(b)];
    const Point &from = points[static_cast<std::size_t>(a)], &to = points[static_cast<std::size_t>(b)];
    const Point x = of_a == 0 ? from : of_b == 0 ? to : Point(from + of_a / (of_a - of_b) * (to - from));
    return {right.dot(x), up.dot(x)};
  };
  std::vector<Line> lines;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto above = [&](std::size_t k) { return height[static_cast<std::size_t>(triangles[t][k % 3])] >= 0; };
    for (std::size_t k = 0; k < 3; ++k) {  // the corner that lies alone on its side
      if (above(k) == above(k + 1) || above(k) == above(k + 2)) continue;
      auto low = crossing(triangles[t][k], triangles[t][(k + 1) % 3]),
           high = crossing(triangles[t][k], triangles[t][(k + 2) % 3]);
      if (low[1] > high[1]) std::swap(low, high);
      if (low[1] < high[1]) lines.push_back({low, high});
    }
  }
  return lines;
}

// Some point of the plane.
Point point_of_plane(const std::vector<Point>& points, const std::vector<double>& height, const Point& normal)
{
  return points.front() - height.front() * normal;
}

}  // namespace

Section cut(const std::vector<Point>& points, const mesh::Cells& cells, const std::vector<double>& height)
{
  std::vector<Local> chosen;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto above = [&](Local n) { return height[static_cast<std::size_t>(n)] >= 0; };
    const auto count = std::count_if(cells[c].begin(), cells[c].end(), above);
    if (count > 0 && count < static_cast<std::ptrdiff_t>(cells[c].size())) chosen.push_back(static_cast<Local>(c));
  }
  Section result;
  if (chosen.empty()) return result;
  const auto grid = grid_of(points, cells, chosen);
  vtkNew<vtkPoints> found;
  found->SetDataTypeToDouble();
  vtkNew<vtkMergePoints> locator;
  locator->InitPointInsertion(found, grid->GetBounds());
  vtkNew<vtkGenericCell> cell;
  vtkNew<vtkDoubleArray> heights;
  vtkNew<vtkCellArray> vertices, lines, polygons;
  vtkNew<vtkPointData> no_point_data, of_points;
  vtkNew<vtkCellData> no_cell_data, of_cells;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    grid->GetCell(static_cast<vtkIdType>(i), cell);
    const auto nodes = cell->GetNumberOfPoints();
    heights->SetNumberOfTuples(nodes);
    for (vtkIdType k = 0; k < nodes; ++k) heights->SetValue(k, height[static_cast<std::size_t>(cell->GetPointId(k))]);
    polygons->Reset();
    cell->Contour(0, heights, locator, vertices, lines, polygons, no_point_data, of_points, no_cell_data,
                  static_cast<vtkIdType>(i), of_cells);
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    for (polygons->InitTraversal(); polygons->GetNextCell(count, corners) != 0;)
      for (vtkIdType k = 2; k < count; ++k) {
        result.triangles.push_back(
            {static_cast<Local>(corners[0]), static_cast<Local>(corners[k - 1]), static_cast<Local>(corners[k])});
        result.cell.push_back(chosen[i]);
      }
  }
  result.points.resize(static_cast<std::size_t>(found->GetNumberOfPoints()));
  for (std::size_t p = 0; p < result.points.size(); ++p) found->GetPoint(static_cast<vtkIdType>(p), result.points[p].data());
  return result;
}

Section enclosed(const std::vector<Point>& points, const mesh::Cells& triangles, const std::vector<double>& height,
                 const Point& normal)
{
  const Point right = normal.unitOrthogonal(), up = normal.cross(right);
  const auto lines = outline(points, triangles, height, right, up);
  std::vector<double> levels;
  for (const auto& [low, high] : lines) levels.insert(levels.end(), {low[1], high[1]});
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  Section result;
  if (lines.empty()) return result;
  const Point origin = point_of_plane(points, height, normal);
  const auto add = [&](double x, double y) {
    result.points.push_back(origin + (x - right.dot(origin)) * right + (y - up.dot(origin)) * up);
    return static_cast<Local>(result.points.size() - 1);
  };
  for (std::size_t band = 0; band + 1 < levels.size(); ++band) {
    const double bottom = levels[band], top = levels[band + 1];
    std::vector<std::array<double, 2>> across;  // where lines enter and leave the band
    for (const auto& [low, high] : lines) {
      if (low[1] > bottom || high[1] < top) continue;
      const auto at = [&, &low = low, &high = high](double y) {
        return low[0] + (y - low[1]) / (high[1] - low[1]) * (high[0] - low[0]);
      };
      across.push_back({at(bottom), at(top)});
    }
    std::sort(across.begin(), across.end(), [](const auto& a, const auto& b) { return a[0] + a[1] < b[0] + b[1]; });
    for (std::size_t i = 0; i + 1 < across.size(); i += 2) {  // in between is inside
      const auto a = add(across[i][0], bottom), b = add(across[i + 1][0], bottom), c = add(across[i + 1][1], top),
                 d = add(across[i][1], top);
      if (across[i][0] < across[i + 1][0]) result.triangles.push_back({a, b, c});
      if (across[i][1] < across[i + 1][1]) result.triangles.push_back({a, c, d});
    }
  }
  result.cell.assign(result.triangles.size(), 0);
  return result;
}

Section refined(Section section, double size)
{
  while (true) {
    std::map<std::pair<Local, Local>, Local> middles;
    const auto middle = [&](Local a, Local b) {
      const auto found = middles.find(std::minmax(a, b));
      return found == middles.end() ? -1 : found->second;
    };
    for (const auto& corners : section.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto edge = std::minmax(corners[k], corners[(k + 1) % 3]);
        const Point a = section.points[static_cast<std::size_t>(edge.first)],
                    b = section.points[static_cast<std::size_t>(edge.second)];
        if ((b - a).norm() <= size || !middles.emplace(edge, static_cast<Local>(section.points.size())).second) continue;
        section.points.push_back((a + b) / 2);
      }
    if (middles.empty()) return section;
    Section finer{std::move(section.points), {}, {}};
    for (std::size_t t = 0; t < section.triangles.size(); ++t) {
      const auto add = [&](Local a, Local b, Local c) {
        finer.triangles.push_back({a, b, c});
        finer.cell.push_back(section.cell[t]);
      };
      // Turned such that the halved edges come first.
      auto n = section.triangles[t];
      std::array<Local, 3> m{middle(n[0], n[1]), middle(n[1], n[2]), middle(n[2], n[0])};
      const auto halved = 3 - std::count(m.begin(), m.end(), -1);
      const auto leads = [&] { return (halved == 1 && m[0] >= 0) || (halved == 2 && m[2] < 0) || halved % 3 == 0; };
      while (!leads()) {
        std::rotate(n.begin(), n.begin() + 1, n.end());
        std::rotate(m.begin(), m.begin() + 1, m.end());
      }
      if (halved == 0) {
        add(n[0], n[1], n[2]);
      } else if (halved == 1) {
        add(n[0], m[0], n[2]), add(m[0], n[1], n[2]);
      } else if (halved == 2) {
        add(m[0], n[1], m[1]), add(n[0], m[0], m[1]), add(n[0], m[1], n[2]);
      } else {
        add(n[0], m[0], m[2]), add(n[1], m[1], m[0]), add(n[2], m[2], m[1]), add(m[0], m[1], m[2]);
      }
    }
    section = std::move(finer);
  }
}

}  // namespace mortise::io
