// Where both sides of a contact are the same cylinder, cone or sphere of the geometry.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "contact/fit.hpp"
#include "integrals/face_integrals.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// The curved surfaces of all faces of a model, spread over the ranks by the faces' numbers.
class CurvedFaces {
 public:
  CurvedFaces() = default;
  /// `faces` of this rank. Collective.
  CurvedFaces(std::span<const CurvedFace> faces, const Communicator& comm);

  /// Of each face the index of its surface in `surfaces`, or -1. Nothing is appended where the model has no curved faces.
  /// Collective.
  std::vector<int> of(const Side& side, std::vector<mesh::CurvedSurface>& surfaces, const Communicator& comm) const;

 private:
  bool any_ = false;
  std::vector<CurvedFace> own_;  // ascending
};

/// The surface nodes of a secondary side against the faces of a primary one.
class OneSurface {
 public:
  OneSurface() = default;
  /// `rotation`: of the primary side, if it is rotated. Collective.
  OneSurface(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary, const CurvedFaces& faces,
             const std::optional<mesh::Motion>& rotation, const Communicator& comm);

  bool anywhere() const { return !of_primary_.empty(); }
  /// Whether a face at the surface node is of a surface that the primary side has, too.
  bool knows(std::size_t surface_node) const;
  /// Whether a face at the surface node is of the surface that a face of the primary side is of.
  bool holds(std::size_t surface_node, std::size_t primary_face) const;
  /// Whether every primary node of `terms` is on such a face.
  bool holds(std::size_t surface_node, std::span<const Term> terms) const;

 private:
  std::vector<int> of_primary_;                         // of each face its surface, or -1
  std::vector<std::pair<Local, int>> at_surface_node_;  // surface node, surface (of the primary side) of a face there; ascending
  std::vector<std::pair<Local, Local>> at_node_;        // primary node, face there; ascending
};

}  // namespace mortise::contact
