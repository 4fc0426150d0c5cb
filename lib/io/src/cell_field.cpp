#include "io/cell_field.hpp"

#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "vtk_cells.hpp"

namespace mortise::io {

void CellArrays::add(const std::vector<Point>& at, const std::vector<double>& value, mesh::CellType type)
{
  std::vector<Local> numbers(at.size());
  std::iota(numbers.begin(), numbers.end(), static_cast<Local>(values.size()));
  if (offsets.empty()) offsets.push_back(0);
  for (const auto n : vtk_nodes(type, numbers)) connectivity.push_back(n);
  offsets.push_back(static_cast<long long>(connectivity.size()));
  types.push_back(static_cast<unsigned char>(vtk_type(type)));
  for (const auto& x : at) points.insert(points.end(), x.data(), x.data() + 3);
  values.insert(values.end(), value.begin(), value.end());
}

struct CellField::Locator {
  CellArrays arrays;
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkStaticCellLocator> cells;
  vtkNew<vtkGenericCell> cell;
  std::vector<double> weights;
};

CellField::CellField(CellArrays arrays) : locator_(std::make_shared<Locator>())
{
  auto& [kept, grid, cells, cell, weights] = *locator_;
  kept = std::move(arrays);
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  places->SetNumberOfPoints(static_cast<vtkIdType>(kept.values.size()));
  for (std::size_t p = 0; p < kept.values.size(); ++p) places->SetPoint(static_cast<vtkIdType>(p), &kept.points[3 * p]);
  grid->SetPoints(places);
  grid->Allocate(static_cast<vtkIdType>(kept.types.size()));
  for (std::size_t c = 0; c < kept.types.size(); ++c) {
    const auto first = kept.offsets[c], count = kept.offsets[c + 1] - first;
    const std::vector<vtkIdType> nodes(&kept.connectivity[static_cast<std::size_t>(first)],
                                       &kept.connectivity[static_cast<std::size_t>(first)] + count);
    grid->InsertNextCell(kept.types[c], static_cast<vtkIdType>(count), nodes.data());
  }
  weights.resize(static_cast<std::size_t>(std::max(grid->GetMaxCellSize(), 1)));
  cells->SetDataSet(grid);
  cells->BuildLocator();
}

CellField::Nearest CellField::nearest(const Point& x) const
{
  const auto& [arrays, grid, cells, cell, weights] = *locator_;
  std::array<double, 3> at{x[0], x[1], x[2]}, parameters{}, place = at, again{};
  int part = 0;
  double square = 0, size = 0;
  vtkIdType found = cells->FindCell(at.data(), 0, cell, parameters.data(), locator_->weights.data());
  if (found < 0) {
    cells->FindClosestPoint(at.data(), place.data(), cell, found, part, square);
    grid->GetCell(found, cell);
    size = std::sqrt(cell->GetLength2());
    double of_place = 0;
    cell->EvaluatePosition(place.data(), again.data(), part, parameters.data(), of_place, locator_->weights.data());
  }
  Nearest result{0, Point(place.data()), std::sqrt(square), static_cast<std::size_t>(found), size};
  const auto first = arrays.offsets[result.cell], end = arrays.offsets[result.cell + 1];
  for (auto i = first; i < end; ++i)
    result.value += weights[static_cast<std::size_t>(i - first)] *
                    arrays.values[static_cast<std::size_t>(arrays.connectivity[static_cast<std::size_t>(i)])];
  return result;
}

}  // namespace mortise::io
