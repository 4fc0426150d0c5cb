// Structured blocks: boxes of equal cells, generated piece by piece where they are needed.
#pragma once

#include <array>

#include "mesh/mesh.hpp"
#include "mesh/options.hpp"

namespace mortise::mesh {

/// The catalogue of options.blocks: each block is a body, in alphabetical order; block "lower" has the boundaries lower.xmin,
/// lower.xmax, .. lower.zmax.
Catalogue block_catalogue(const Options& options, int dimension);

/// The cells with indices first .. last - 1 an axis of the `block`-th block (in 2D the third entries are 0 and 1). Numbers and
/// coordinates of nodes depend on their place in the block alone, so neighbouring pieces agree to the last bit. hexahedra and
/// quadrilaterals are whole grid cells; tetrahedra make six of one, around its diagonal; prisms and triangles two.
Mesh generate(const Options& options, int dimension, int block, std::array<int, 3> first, std::array<int, 3> last);

/// The numbers of a block's first node and cell.
struct First {
  Global node = 0, cell = 0;
};
/// The first numbers of the `block`-th block; for the block after the last the totals.
First first_numbers(const Options& options, int dimension, int block);

/// Grid cells an axis of the `block`-th block; the third is 1 in 2D.
std::array<int, 3> grid_of(const Options& options, int dimension, int block);

}  // namespace mortise::mesh
