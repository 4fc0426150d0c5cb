// The deck's section `mesh`.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deck/description.hpp"
#include "mesh/instances.hpp"

namespace mortise::mesh {

/// A box of equal cells. 2D: two entries an array; the third entry of `cells` is then 0.
struct BlockOptions {
  std::array<double, 3> origin{0, 0, 0};
  std::array<double, 3> size{1, 1, 1};
  std::array<int, 3> cells{1, 1, 1};
  std::string element = "hex8";  ///< a cell by name, of the deck's dimension
};

/// How large the cells are that gmsh makes of a geometry; what is not given is left to the geometry and to gmsh.
struct SizeOptions {
  std::optional<double> max, min;   ///< edge lengths, in the file's unit
  std::optional<double> curvature;  ///< cells round a full turn of a curved surface
};

struct Options {
  std::string file;                            ///< absolute path by the time it gets here; empty: `blocks` are used
  std::map<std::string, double> constants;     ///< gmsh's -setnumber, for files that gmsh meshes
  SizeOptions size;                            ///< for files that gmsh meshes
  std::optional<int> order;                    ///< of the cells, for files that gmsh meshes
  std::optional<int> dimension;                ///< of the cells, for files that gmsh meshes; absent: the model's
  double time_limit = 3600;                    ///< seconds that gmsh may take
  bool allow_scripts = false;                  ///< of the command line: a .geo may start programs and write files
  double scale = 1.0;                          ///< coordinates of the file or of the blocks are multiplied by this
  std::map<std::string, BlockOptions> blocks;  ///< by body name

  // From the section `bodies`.
  std::map<std::string, std::vector<Motion>> instances;     ///< by group: where its copies are
  std::map<std::string, std::vector<std::string>> volumes;  ///< by group: the physical volumes of which it is made, if several
  /// By group of boundary elements: the physical surfaces (plane models: curves) that enclose it, where the file has no cells of
  /// it.
  std::map<std::string, std::vector<std::string>> surfaces;
};

/// The keywords.
void describe(deck::Description<BlockOptions>& d);
void describe(deck::Description<SizeOptions>& d);
void describe(deck::Description<Options>& d);

}  // namespace mortise::mesh
