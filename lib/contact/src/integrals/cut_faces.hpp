// The faces of a secondary side in pieces, and which functions of which pieces belong to each surface node.
#pragma once

#include <ranges>
#include <span>
#include <vector>

#include "integrals/pieces.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

class CutFaces {
 public:
  /// The k-th function of a piece of a face.
  struct Function {
    std::size_t face, piece;
    Eigen::Index k;
  };

  /// Both must outlive it. `own`: of each node whether this rank makes its rows. `rings`: of round(), round those of near().
  CutFaces(const Side& side, const SurfaceNodes& surface_nodes, const std::vector<char>& own, int rings = 1);

  /// Faces round this rank's nodes, whose share of the rows is needed; ascending.
  const std::vector<std::size_t>& near() const { return near_; }
  /// And those round their nodes, ring by ring, whose integrals are.
  const std::vector<std::size_t>& round() const { return round_; }

  /// The next face of round() with its pieces.
  void add(std::size_t face, std::span<const PieceIntegrals> pieces);
  std::ranges::iota_view<std::size_t, std::size_t> pieces(std::size_t face) const { return {begin_[face], end_[face]}; }
  PieceStore::View piece(std::size_t i) { return store_[i]; }

  /// Numbers the corners of the primary side that have rows of their own, once all faces are added.
  void number_corners();
  /// Places of multipliers: the surface nodes, and after them the corners.
  std::size_t places() const { return nodes_.all.size() + corners_.size(); }
  /// The surface node at or beside a place.
  std::size_t surface_node(std::size_t place) const
  {
    return place < nodes_.all.size() ? place : static_cast<std::size_t>(corners_[place - nodes_.all.size()].second);
  }
  bool is_corner(std::size_t place) const { return place >= nodes_.all.size(); }

  /// The surface nodes at the nodes of a face.
  std::span<const Local> surface_nodes_of(std::size_t face) const
  {
    return std::span(nodes_.of_node).subspan(static_cast<std::size_t>(side_.faces.offset[face]), side_.faces[face].size());
  }
  /// The surface node that a function belongs to, or beside it.
  std::size_t surface_node_of(std::size_t face, const PieceStore::View& piece, Eigen::Index k) const;
  /// The place that it belongs to.
  std::size_t place_of(std::size_t face, const PieceStore::View& piece, Eigen::Index k) const;

  /// Sorts the functions of near() by their places, ascending by face and piece.
  void sort_by_nodes();
  std::span<const Function> at(std::size_t place) const
  {
    return std::span(functions_).subspan(first_[place], first_[place + 1] - first_[place]);
  }

 private:
  const Side& side_;
  const SurfaceNodes& nodes_;
  std::vector<std::size_t> near_, round_;
  PieceStore store_;
  std::vector<std::size_t> begin_, end_;          // of each face in store_
  std::vector<std::pair<Local, Local>> corners_;  // of each corner the primary side's node and the surface node beside it
  std::vector<std::size_t> first_;                // of each place in functions_
  std::vector<Function> functions_;
};

}  // namespace mortise::contact
