// Fields on meshes for ParaView, one piece a rank.
#pragma once

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

struct Piece {
  std::vector<Point> points;
  mesh::Cells cells;
  std::vector<Field> point_fields, cell_fields;  ///< the same names on every rank
};

/// Writes `name`_0.vtu, `name`_1.vtu ... (compressed), `name`.pvtu on several ranks, and last `name`.pvd, which opens them.
/// Throws Error(machine) on all ranks if one fails; then none of these files is there. Collective.
void write_vtk(const std::string& directory, const std::string& name, const Piece& piece, const Communicator& comm);

/// What a .pvd file opens: a file at each time.
struct Series {
  std::string name;
  std::vector<std::pair<double, std::string>> frames;
};
/// The same for one state of many: `series.name`.1_0.vtu ... and a .pvd of all that were written so far. Collective.
void write_vtk(const std::string& directory, Series& series, double time, const Piece& piece, const Communicator& comm);

}  // namespace mortise::io
