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

namespace {

constexpr double within = 1e-6;  // of the reference cell, that rounding may leave it

// Moves a place of the reference cell that lies outside it towards its middle, until it lies on its border.
void draw_in(vtkCell* cell, std::array<double, 3>& place)
{
  if (!(cell->GetParametricDistance(place.data()) > 0)) return;
  std::array<double, 3> middle{}, now{};
  cell->GetParametricCenter(middle.data());
  double inside = 0, outside = 1;
  for (int step = 0; step < 50; ++step) {
    const double part = (inside + outside) / 2;
    for (std::size_t c = 0; c < 3; ++c) now[c] = middle[c] + part * (place[c] - middle[c]);
    (cell->GetParametricDistance(now.data()) > 0 ? outside : inside) = part;
  }
  for (std::size_t c = 0; c < 3; ++c) place[c] = middle[c] + inside * (place[c] - middle[c]);
}

}  // namespace

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
  const auto& [arrays, grid, cells, cell, all_weights] = *locator_;
  std::array<double, 3> at{x[0], x[1], x[2]}, parameters{}, place{}, unused{};
  double* const weights = locator_->weights.data();
  int part = 0;
  double square = 0;
  vtkIdType found = cells->FindCell(at.data(), 0, cell, parameters.data(), weights);
  if (found < 0 || cell->GetParametricDistance(parameters.data()) > within) {
    cells->FindClosestPoint(at.data(), place.data(), cell, found, part, square);
    grid->GetCell(found, cell);
    // Of a place beside a face of second order, in its plane, VTK gives that place itself, and the distance all the same.
    const Point away = x - Point(place.data());
    const bool is_it = std::abs(away.squaredNorm() - square) <= within * square;
    double again = 0;
    cell->EvaluatePosition(is_it ? place.data() : at.data(), unused.data(), part, parameters.data(), again, weights);
  }
  draw_in(cell, parameters);
  cell->EvaluateLocation(part, parameters.data(), place.data(), weights);
  Nearest result{0, Point(place.data()), std::sqrt(square), static_cast<std::size_t>(found), std::sqrt(cell->GetLength2())};
  const auto first = arrays.offsets[result.cell], end = arrays.offsets[result.cell + 1];
  for (auto i = first; i < end; ++i)
    result.value += weights[static_cast<std::size_t>(i - first)] *
                    arrays.values[static_cast<std::size_t>(arrays.connectivity[static_cast<std::size_t>(i)])];
  return result;
}

}  // namespace mortise::io
