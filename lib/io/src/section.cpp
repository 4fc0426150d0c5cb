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
