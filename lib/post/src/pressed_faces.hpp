// Which faces of a contact's secondary side press, and how wide what they make up is.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "contact/state.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// How many corners of a face are pressed, of how many. One without rows is if all of the face's nodes with rows are.
std::pair<std::ptrdiff_t, std::ptrdiff_t> pressed_corners(const mesh::Surface& side, const contact::SurfaceState& state,
                                                          std::size_t face);

/// Pressed faces of a contact that hang together, over all ranks: a roller in a V presses on two such patches. A node is inside
/// if it is pressed and no corner of its faces is open; the border of the side, or of what it covers, ends nothing: the contact
/// is cut there by the bodies, not by its gaps.
struct PressedPatch {
  int contact = 0;
  double whole = 0;         ///< faces that are pressed at all corners: none where the contact is narrower than a face
  double second_order = 0;  ///< how many of them have middle nodes
  double inside = 0;        ///< nodes inside, counted once a face: none where it is one face wide
  double core = 0;          ///< faces all corners of which are inside: none where it is two faces wide
  double force = 0;         ///< sum of |normal force| of its nodes
  double between = 0;       ///< the part of it that acts at places between nodes
  Found node, recovered;    ///< the largest pressure of a node, and of the means over faces
};
/// By contact, bonded ones apart; the same on every rank. `states`: states of this rank's contact nodes. Collective.
std::vector<PressedPatch> pressed_patches(std::span<const contact::SurfaceState> surfaces,
                                          std::span<const contact::ContactNodeState> states, std::span<const contact::Pair> pairs,
                                          const Communicator& comm);

}  // namespace mortise::post
