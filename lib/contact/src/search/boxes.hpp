// Boxes round the faces of a surface, and parts of it.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "search/tree.hpp"

namespace mortise::contact {

/// Boxes round the nodes of faces.
std::vector<Box> boxes_of_faces(const mesh::Surface& side);

/// Halves the boxes `order` at the median of their longest side until no part has more than `most`; `use` gets the box round each
/// part and its members.
void halve(const std::vector<Box>& boxes, std::span<int> order, std::size_t most,
           const std::function<void(const Box&, std::span<const int>)>& use);

/// The faces `chosen`, ascending, of a surface, as a surface of their own.
mesh::Surface part_of(const mesh::Surface& side, std::span<const std::size_t> chosen);

}  // namespace mortise::contact
