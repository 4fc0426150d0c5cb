// Who is whose neighbour: the faces of cells, matched by their nodes.
#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace mortise::mesh {

/// A face of a cell, identified by its sorted corners (unused places -1).
struct CellFace {
  std::array<Local, 4> corners{-1, -1, -1, -1};
  Local cell = 0;
  int face = 0;
};

/// CellFace::corners of a face with these corners, at most four.
std::array<Local, 4> face_key(std::span<const Local> corners);

/// All faces of all cells, ordered by corners and then by cell, so that faces shared by two cells stand side by side.
std::vector<CellFace> sorted_faces(const Cells& cells);

/// Those of sorted_faces() that belong to one cell alone: the border.
std::vector<CellFace> border_faces(const Cells& cells);

/// For each cell the cells that share a face with it, ascending, in compressed rows.
struct Neighbours {
  std::vector<Local> offset{0};
  std::vector<Local> cells;
  std::span<const Local> operator[](std::size_t i) const
  {
    return {cells.data() + offset[i], static_cast<std::size_t>(offset[i + 1] - offset[i])};
  }
};
/// The neighbours of all cells of one mesh: the graph that partitions are cut from.
Neighbours face_neighbours(const Cells& cells);
/// The same of so many cells, from their sorted_faces().
Neighbours face_neighbours(std::span<const CellFace> faces, std::size_t cells);

/// Connected parts of the graph, where cells are connected only if `label` agrees: the part of each cell, numbered in the order
/// of their smallest cells.
std::vector<int> connected_parts(const Neighbours& neighbours, const std::vector<int>& label);

/// Cuts meshes out of `mesh`, to which it refers; each takes time by its own size.
class Submeshes {
 public:
  explicit Submeshes(const Mesh& mesh);
  /// That of some cells, ascending indices: its nodes are those of the cells, its facets those whose parents are among them.
  Mesh operator()(std::span<const Local> cells);

 private:
  const Mesh& mesh_;
  std::vector<Local> local_;              ///< of each node: its number in the piece that is made; -1 between pieces
  std::vector<std::size_t> first_facet_;  ///< of each cell, in facet_; and the end
  std::vector<std::size_t> facet_;        ///< facets, cell by cell
};

}  // namespace mortise::mesh
