// Bonds on planes of symmetry and other supports that hold both sides. Where they hold a node of the secondary side and what lies
// opposite along a direction a, as at an edge that both sides end at, it has no row along a. Its function also covers nodes of
// the primary side that do move, which would lack its share of the traction: along a the others of its faces take over, with
// functions psi^a whose sum is 1 and which are dual among them, as everywhere for nodes without multipliers [cf. the crosspoints
// of Wohlmuth, SIAM J. Numer. Anal. 38 (2000)]. Their rows along t become
//
//     integral psi t . [u]  +  (t . a) integral (psi^a - psi) a . [u].
//
// Where primary and secondary nodes lie opposite each other nothing is left to take over. A face all of whose nodes are held so,
// as a triangle across a corner, has nobody to take over: if most of what lies opposite is held as well, nodes of the faces
// beside it take equal parts of the constant 1 in its place, so that a constant traction stays one. Else its nodes keep their
// rows.
#pragma once

#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "integrals/cut_faces.hpp"
#include "integrals/face_integrals.hpp"
#include "rows/rows.hpp"
#include "rows/supported_nodes.hpp"
#include "search/small.hpp"

namespace mortise::contact {

class SharesBesideSupports {
 public:
  /// Nothing is shared.
  SharesBesideSupports() = default;
  /// What supports hold of the primary side along a direction.
  struct OnPrimary {
    std::function<bool(std::size_t p, const Point& axis)> opposite;  ///< of what lies opposite a surface node,
    /// opposite a point where a function stands that belongs to one
    std::function<bool(std::size_t p, const Point& at, const Point& axis)> opposite_at;
    std::function<bool(Local node, const Point& axis)> at_node;  ///< and at a node
  };
  /// `faces` with their integrals, which become functions of the places that are `kept` later.
  SharesBesideSupports(const Side& secondary, const SurfaceNodes& nodes, CutFaces& faces, const SupportedNodes& supports,
                       std::span<const char> kept, const OnPrimary& on_primary, int dimension);

  /// Whether a surface node leaves its share along a direction to others.
  bool gives(std::size_t p, const Point& direction) const;
  /// The unit vector along what a direction has besides those.
  Point rest_of(std::size_t p, Point direction) const;

  /// Once the faces have their functions.
  void take_functions(CutFaces& faces);
  /// What others leave to a place's row along a direction, where D is `d`. Valid until the next call.
  std::vector<RowWriter::Couple> to(std::size_t place, double d, const Point& direction);

 private:
  using Axes = Few<Point, 3>;
  // A piece whose functions along an axis are others.
  struct Other {
    std::size_t face, piece, copy;  // in other_
    Point axis;
  };
  // A piece along an axis of which nobody has a function, who takes the constant, and the integrals of that.
  struct Stray {
    std::size_t face, piece;
    Point axis;
    std::vector<std::size_t> takers;
    std::vector<Term> constant;
  };
  // Integrals of psi^a - psi, as terms.
  struct Share {
    Point axis;
    std::vector<Term> terms;
  };
  Axes axes_of(std::size_t face, const CutFaces& faces) const;
  void find_given(const SurfaceNodes& nodes, CutFaces& faces, const SupportedNodes& supports, const OnPrimary& on_primary,
                  int dimension);
  void find_strays(CutFaces& faces, std::span<const char> kept, const OnPrimary& on_primary);
  std::vector<std::size_t> takers_beside(std::size_t face, const Point& axis, std::span<const char> kept,
                                         const CutFaces& faces) const;
  Few<char, most_functions> takers(std::size_t face, const PieceStore::View& piece, const Point& axis, std::span<const char> kept,
                                   const CutFaces& faces) const;
  std::vector<Term> terms_of_constant(std::size_t face, const PieceStore::View& piece) const;
  Share& share_of(std::size_t place, const Point& axis);

  const Side* secondary_ = nullptr;
  std::vector<Axes> given_;  // of each surface node; orthonormal
  PieceStore other_;
  std::vector<Other> others_;
  std::vector<Stray> strays_;
  std::unordered_map<std::size_t, std::vector<Share>> shares_;  // of places that get something
  std::vector<std::vector<Term>> handed_;                       // to the row at work
};

}  // namespace mortise::contact
