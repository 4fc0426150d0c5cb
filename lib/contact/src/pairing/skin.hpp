// The outer faces of all bodies that have to do with another body, and how far those are looked for.
#pragma once

#include <algorithm>
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

/// This rank's faces that have to do with another body. Collective.
mesh::Surface near_others(const mesh::Surface& skin, const Lengths& lengths, const Communicator& comm);

/// The near faces of all bodies, the same on every rank.
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

/// Collective.
Skin gather_skin(const mesh::Surface& near, fem::Kinematics kinematics, const Communicator& comm);

}  // namespace mortise::contact
