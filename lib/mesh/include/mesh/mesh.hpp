// The mesh of an assembly, or of any piece of it: a plain value. A whole assembly read from a file, one body, and one subdomain
// are all a Mesh; what they share by name (bodies, boundaries) stands once in a Catalogue that every rank holds.
//
// Two bodies never share a node, whatever the file says: where they touch, each has a node of its own.
#pragma once

#include <string>
#include <vector>

#include "mesh/cell.hpp"

namespace mortise::mesh {

/// A connected set of cells, or of a body that the file holds as its surface alone the cells of that, turned outward: such cells
/// are of one dimension less than the catalogue's. A physical group of several connected parts makes several bodies, named
/// group.1, group.2, ...
struct Body {
  std::string name;   ///< unique; equal to `group` if the group is connected
  std::string group;  ///< the physical volume (2D: surface) of the file, the closed surface, or the block: the deck's name
  std::string instance = {};  ///< group.i if it belongs to the i-th instance of its group; empty if there are none
};
/// Its instance, or else its group: what its connected parts are parts of.
inline const std::string& whole_of(const Body& body)
{
  return body.instance.empty() ? body.group : body.instance;
}

/// Nodes that have a name in the file and need be no boundary: those of a physical curve (plane models: none) or point, of an
/// *NSET without a whole face. Of every body that has a node there.
struct NodeSet {
  std::string name;
  std::vector<Global> nodes;
  std::vector<double> weights;  ///< of each node of a curve the length that belongs to it; of points 1
};

/// The names of an assembly, the same on every rank.
struct Catalogue {
  int dimension = 3;
  std::vector<Body> bodies;
  std::vector<std::string> boundaries;  ///< named surfaces (2D: curves)
  std::vector<std::string> volumes;     ///< physical volumes of the file or blocks; of a body of one volume equal to its group
  std::vector<NodeSet> node_sets;
  Global node_count = 0;  ///< over all ranks, nodes shared by subdomains counted once
  Global cell_count = 0;
};

/// Faces on named boundaries. A face that lies on two boundaries stands here twice.
struct Facets {
  Cells cells;                ///< lines, or triangles and quadrilaterals, oriented so that the normal points out of the body
  std::vector<Local> parent;  ///< the cell of the Mesh that it is a face of, or that it is (see Body)
  std::vector<int> boundary;  ///< index into Catalogue::boundaries
};

/// A whole assembly, a body, or any piece of one. Plain data.
struct Mesh {
  std::vector<Global> node_id;  ///< global number of each local node, unique over all bodies; ascending
  std::vector<Point> points;    ///< coordinates of each local node
  Cells cells;
  std::vector<Global> cell_id;  ///< global number of each cell
  std::vector<int> cell_body;   ///< index into Catalogue::bodies
  /// Index into Catalogue::volumes; empty if every body is of one volume.
  std::vector<int> cell_volume;
  Facets facets;

  /// Of this piece.
  std::size_t node_count() const { return points.size(); }
};

/// Faces cut out of a mesh, to stand alone: what contact works on. Distributed: each face on exactly one rank.
struct Surface {
  std::vector<Global> node_id;  ///< ascending
  std::vector<Point> points;
  Cells faces;
  std::vector<Global> face_id;  ///< unique over all ranks and independent of their number
  std::vector<int> body;        ///< of each face
};

}  // namespace mortise::mesh
