// The deck's section `mesh`.
#pragma once

#include <array>
#include <map>
#include <string>

#include "deck/description.hpp"

namespace mortise::mesh {

/// A box of equal cells. 2D: two entries an array; the third entry of `cells` is then 0.
struct BlockOptions {
  std::array<double, 3> origin{0, 0, 0};
  std::array<double, 3> size{1, 1, 1};
  std::array<int, 3> cells{1, 1, 1};
  std::string element = "hex8";  ///< a cell by name, of the deck's dimension
};

struct Options {
  std::string file;                            ///< absolute path by the time it gets here; empty: `blocks` are used
  std::map<std::string, double> constants;     ///< gmsh's -setnumber, for files that gmsh meshes
  double scale = 1.0;                          ///< coordinates of the file or of the blocks are multiplied by this
  std::map<std::string, BlockOptions> blocks;  ///< by body name
};

/// The keywords.
void describe(deck::Description<BlockOptions>& d);
void describe(deck::Description<Options>& d);

}  // namespace mortise::mesh
