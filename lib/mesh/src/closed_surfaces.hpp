// Bodies that a file holds as their surface alone: which closed surfaces bound one body, and which side of them is out.
#pragma once

#include <vector>

#include "raw_mesh.hpp"

namespace mortise::mesh {

/// Turns the cells of surfaces (those of a dimension less than the model's) so that their normals point out of the body, and
/// returns for each cell of `raw` the body that it bounds, 0, 1, .., or -1 for cells of the model's dimension.
///
/// `group`: of each cell; a surface bounds a body of its own group. A surface that lies in no other one, or in a cavity of one,
/// is the outer surface of a body; one that lies in a body is its cavity. Throws Error(bad_input), which names the file and a
/// place, where a surface is open, where more than two of its cells meet at an edge, where it cannot be turned one way (a Moebius
/// strip), encloses nothing, has cells of different orders side by side, or crosses another one.
std::vector<int> close_surfaces(RawMesh& raw, const std::vector<int>& group, const std::string& file, int dimension);

}  // namespace mortise::mesh
