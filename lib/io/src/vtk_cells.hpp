// Cells as VTK has them.
#pragma once

#include <vtkType.h>

#include <span>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::io {

int vtk_type(mesh::CellType type);

/// The nodes of a cell in VTK's order.
std::vector<vtkIdType> vtk_nodes(mesh::CellType type, std::span<const Local> nodes);

}  // namespace mortise::io
