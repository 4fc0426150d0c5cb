// The outer faces of all bodies that have to do with another body, and how far those are looked for.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "search/tree.hpp"
#include "surface/side.hpp"

namespace mortise::contact {

/// Part of the smaller face's size that a gap may have where the deck gives no distance.
inline constexpr double part_of_face = 0.5;
/// Cosine of the angle from which neighbouring faces make a kink; find_surface_nodes() takes it too.
inline constexpr double kink = 0.766;
/// Lengths below this part of a face's size are rounding.
inline constexpr double rounding = 1e-6;

inline std::size_t at(int index)
{
  return static_cast<std::size_t>(index);
}

inline Box grown(const Box& box, double margin)
{
  return Box(box.min() - Point::Constant(margin), box.max() + Point::Constant(margin));
}

/// How far lines go and patches reach.
struct Lengths {
  double given;         ///< the deck's distance, or 0
  double interference;  ///< of the deck
  bool bonded;
  std::vector<double> diagonal;  ///< of each body

  /// The range of gaps of faces of these sizes that face each other.
  std::pair<double, double> window(double size, double other) const;
  double longest(double size) const;
  double reach(double largest, int body, int other) const;
  /// Faces farther apart than this have nothing to do with each other: the rays of a discretization go twice as far as its reach.
  double margin(double size, int body, double other_size, int other) const;
};

/// The diagonals of the bodies' boxes. Collective.
std::vector<double> diagonals(const mesh::Surface& skin, int bodies, const Communicator& comm);

/// Of each face the longest distance of two corners.
std::vector<double> sizes_of(const mesh::Surface& skin);

/// Boxes round some faces each of the pieces of bodies that ranks have, the same on every rank.
class PiecesOfBodies {
 public:
  /// Collective.
  PiecesOfBodies(const mesh::Surface& skin, int bodies, const Communicator& comm);

  /// This rank's faces that have to do with another body.
  mesh::Surface near_others(const mesh::Surface& skin, const Lengths& lengths) const;

  /// For each rank the faces of `near` that it has to know, besides its own, where places on its own look for those of other
  /// bodies as far as `reach` and half the size of a face: those, what meets its own in a node, and the neighbours of all these.
  /// `size`: of the largest face in `near` on any rank, by bodies.
  std::vector<std::vector<std::size_t>> needed_by_ranks(const mesh::Surface& near, double reach, const std::vector<double>& size,
                                                        const Communicator& comm) const;

 private:
  // A box round some faces of one body.
  struct Part {
    std::array<double, 6> box;
    double size;  // of its largest face
    int body, rank;
  };
  static std::vector<Part> parts_of(const mesh::Surface& skin, const Communicator& comm);

  std::vector<Part> parts_;
  std::vector<Box> boxes_;
  Tree tree_;
  std::vector<double> largest_;  // size of any face, by bodies
};

/// The near faces of bodies: all of them, the same on every rank, or those that a rank has to know.
struct Skin {
  Side side;
  std::vector<Global> face_id;
  std::vector<int> body;           ///< of each face, as what follows
  std::vector<double> size, area;  ///< of the face through its corners
  std::vector<Point> normal;
  std::vector<Box> box;
  std::vector<FaceGeometry> facet;  ///< of each facet, as what follows
  std::vector<Point> facet_normal;

  std::size_t count() const { return body.size(); }
};

Skin skin_of(Side side, std::vector<int> body_of_face);
/// Of all ranks. Collective.
Skin gather_skin(const mesh::Surface& near, fem::Kinematics kinematics, const Communicator& comm);

}  // namespace mortise::contact
