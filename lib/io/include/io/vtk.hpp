// Fields on meshes for ParaView, one piece a rank.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "mesh/cell.hpp"

namespace mortise::io {

/// Values by point or cell, `components` of each in a row; integers are stored as such.
struct Field {
  std::string name;
  int components = 1;
  std::vector<double> values;
  bool integer = false;
};

/// This rank's part of a mesh with its fields.
struct Piece {
  std::vector<Point> points;
  mesh::Cells cells;
  std::vector<Field> point_fields, cell_fields;  ///< the same names on every rank
  /// Arrays of strings in the file's field data: the name of each and its entries.
  std::vector<std::pair<std::string, std::vector<std::string>>> words = {};
};

/// These cells of a piece, with the points that they use and the words.
Piece part_of(const Piece& piece, const std::vector<std::size_t>& cells);

/// Writes `name`_0.vtu, `name`_1.vtu ... (compressed), `name`.pvtu on several ranks, and last `name`.pvd, which opens them.
/// Throws Error(machine) on all ranks if one fails; then none of these files is there. Collective.
void write_vtk(const std::string& directory, const std::string& name, const Piece& piece, const Communicator& comm);

/// What a .pvd file opens: a file at each time.
struct Series {
  std::string name;
  std::vector<std::pair<double, std::string>> frames;
};
/// The same for one state of many: `series.name`.1_0.vtu ... and a .pvd of all states so far, this one included. Collective.
void write_vtk(const std::string& directory, Series& series, double time, const Piece& piece, const Communicator& comm);

/// A part of the model with a name, which can be hidden: "bodies", "ring".
struct Block {
  std::string group, name;
  Piece piece;  ///< of this rank, without cells if it has none of it
};

/// `series.name`.vtm, or of one state of many `series.name`.K.vtm, which groups the blocks under their names; a file
/// `series.name`.bI_R.vtu for each block and rank that has cells of it; and `series.name`.pvd. Blocks of one group stand side by
/// side, in the same order on every rank. Throws as write_vtk(). Collective.
void write_blocks(const std::string& directory, Series& series, std::optional<double> time, const std::vector<Block>& blocks,
                  const Communicator& comm);

}  // namespace mortise::io
