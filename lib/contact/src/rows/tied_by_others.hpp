// Whether a bond holds what it covers without some of its nodes.
#pragma once

#include <vector>

#include "integrals/cut_faces.hpp"

namespace mortise::contact {

/// Of each surface node of `aside` (1 or 0 each): whether the rows of the others, in the faces round it and next to these, hold
/// what of the primary side its own meets against rotations as well: the centres of what they see spread, weighted with their
/// areas, in two directions (in plane models one) by a part of what those of all do. A rotation about a line on which they lay
/// would be free. `dimension`: 2 or 3. Needs a ring of faces round those of which it is asked.
std::vector<char> tied_by_others(const Side& secondary, CutFaces& faces, const std::vector<char>& aside,
                                 const std::vector<char>& stay, int dimension);

}  // namespace mortise::contact
