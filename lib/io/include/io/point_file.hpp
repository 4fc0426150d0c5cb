// Points from a text file.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"

namespace mortise::io {

struct ListedPoint {
  Point at;
  int line;  ///< of the file, from 1
};

/// A point a line: three numbers, in plane models two, with commas, semicolons or blanks between them. Empty lines, comments
/// that begin with #, and a first line of names are passed over. Throws Error(bad_input), with the line, on all ranks.
/// Collective.
std::vector<ListedPoint> read_points(const std::string& path, int dimension, const Communicator& comm);

}  // namespace mortise::io
