// results.h5: the numbers of a run, for comparison and restart, in an order that does not depend on the number of ranks.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"
#include "mesh/mesh.hpp"

namespace mortise::io {

/// A table whose rows have global numbers 0 .. total-1, each on one rank; `columns` values a row.
struct Table {
  std::string name;         ///< e.g. "nodes/displacement"
  std::string description;  ///< stored as the attribute "description"
  int columns = 1;
  Global total = 0;         ///< the same on every rank
  std::vector<Global> row;  ///< numbers of this rank's rows
  std::vector<double> values;
};

/// The tables "cells/nodes", the numbers of a cell's nodes in VTK's order, -1 after the last, and "cells/type", VTK's number of
/// its shape, of the cells of these meshes. `total`: the cells of all ranks, whose numbers (Mesh::cell_id) are below it.
/// Collective.
std::vector<Table> cell_tables(const std::vector<const mesh::Mesh*>& meshes, Global total, const Communicator& comm);

/// Writes all tables collectively: row i of the data set is the row with number i. Throws Error(machine) on all ranks if the file
/// cannot be written or a table has not each of its rows once; then there is no file. Collective.
void write_results(const std::string& path, const std::vector<Table>& tables, const Communicator& comm);

/// The values of one table of such a file, row by row. Throws Error(bad_input) if there is none. Not collective.
std::vector<double> read_table(const std::string& path, const std::string& name);

}  // namespace mortise::io
