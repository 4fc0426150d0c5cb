// An assembly cut into subdomains: each is a face-connected set of cells of one body and lives on one rank.
#pragma once

#include <vector>

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"

namespace mortise::partition {

/// A piece of one body on one rank.
struct Subdomain {
  Global id = 0;    ///< over all ranks and bodies
  int body = 0;     ///< index into Catalogue::bodies
  mesh::Mesh mesh;  ///< its own cells, nodes and boundary facets; nodes on its border are copied in the neighbours
  /// Known by its surface alone: `mesh` is closed, its cells are panels, of type tri3 in space and line2 in a plane, turned as
  /// facets are; every node lies on the surface, and the parent of a facet is the panel that it is. See skins().
  bool skin = false;
  /// Of a skin, if asked for: the cells that it encloses, or else empty. Its first nodes are those of `mesh`, in the same order
  /// and with the same numbers.
  mesh::Mesh inside = {};
};

/// This rank's part of an assembly cut into subdomains.
struct Decomposition {
  mesh::Catalogue catalogue;
  std::vector<Subdomain> subdomains;  ///< of this rank, ascending ids
  std::vector<Global> first;          ///< rank r owns the subdomains first[r] .. first[r+1]-1; length ranks + 1
  /// Cluster c is the subdomains clusters[c] .. clusters[c+1]-1, of one body, on one rank, connected by cell faces; length
  /// cluster_count() + 1. Without clusters each subdomain is one of its own.
  std::vector<Global> clusters;

  Global subdomain_count() const { return first.back(); }                            ///< over all ranks
  Global cluster_count() const { return static_cast<Global>(clusters.size()) - 1; }  ///< over all ranks
  /// Whether some cluster has several subdomains.
  bool clustered() const { return cluster_count() < subdomain_count(); }
  /// The rank that owns a subdomain.
  int rank_of(Global subdomain) const;
};

/// The faces of one named boundary that lie on this rank's subdomains, of those bodies for which `on_body` is true.
mesh::Surface boundary_surface(const Decomposition& decomposition, int boundary, const std::vector<bool>& on_body);

}  // namespace mortise::partition
