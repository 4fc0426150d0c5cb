// The faces near other bodies, each on the ranks that have to know it.
#pragma once

#include "pairing/skin.hpp"

namespace mortise::contact {

/// This rank's faces that have to do with other bodies, and of those of other ranks what places on them may lie behind, in the
/// order of their numbers. Does not change.
class NearSkin {
 public:
  /// `now`: the outer surface of all bodies, this rank's faces. `reach`: how far from places faces of other bodies are looked
  /// for. Collective.
  NearSkin(const mesh::Surface& now, int bodies, const Lengths& lengths, double reach, fem::Kinematics kinematics,
           const Communicator& comm);

  const Skin& skin() const { return skin_; }
  /// Of each face the rank that has it; what several faces share is that of the lowest one.
  const std::vector<int>& rank() const { return rank_; }
  int rank_of_facet(std::size_t facet) const { return rank_[at(skin_.side.face_of[facet])]; }

  /// Other points of the skin: those of a surface with the faces of `now`. Collective.
  std::vector<Point> points_of(const mesh::Surface& surface, const Communicator& comm) const;

 private:
  mesh::Surface near_;
  std::vector<std::vector<std::size_t>> needed_;  // of these, by each rank
  Skin skin_;
  std::vector<int> rank_;
};

}  // namespace mortise::contact
