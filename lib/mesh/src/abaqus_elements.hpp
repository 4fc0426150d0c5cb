// The cells of Abaqus and CalculiX: their names, their faces, and the order of their nodes [CalculiX CrunchiX USER'S MANUAL].
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::mesh {

/// What a name of an element stands for: nothing, where it is known and left out (lines in space, points, springs).
struct ElementType {
  std::optional<CellType> type;
  bool known = true;
};
/// By the name's letters (which family) and its first number (how many nodes); `name` in capitals.
ElementType element_type(const std::string& name, int dimension);

/// Their faces S1, S2, .. of a first-order cell by our corners.
std::vector<std::vector<int>> abaqus_faces(CellType first_order);

/// The nodes of a cell in our order.
std::vector<Local> cell(CellType type, const std::vector<Local>& theirs);

/// The nodes of a line of second order with the middle one last, wherever the file has it.
std::vector<Local> middle_last(std::vector<Local> nodes, const std::vector<Point>& points);

}  // namespace mortise::mesh
