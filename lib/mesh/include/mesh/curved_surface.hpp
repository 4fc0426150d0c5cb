// The cylinders, cones and spheres (plane models: circles) of a geometry, which faces of its mesh only approximate. Two bodies
// whose faces lie on one of them touch there, whatever their meshes say.
//
// A mesh carries them as boundaries whose names say which surface it is: so they go where faces go, through files, ranks and
// instances. Nobody else is to see these names.
#pragma once

#include <optional>
#include <string>

#include "mesh/instances.hpp"

namespace mortise::mesh {

/// A cone, cylinders included, or a sphere (plane models: a circle).
struct CurvedSurface {
  Point point = Point::Zero();  ///< on the axis, amid the face; of a sphere its centre
  Point axis = Point::Zero();   ///< unit; zero: a sphere
  double radius = 0;            ///< at `point`, > 0
  double slope = 0;             ///< of the radius along the axis; 0: a cylinder

  /// How far x is from it, positive outside; of a cone across its axis.
  double distance(const Point& x) const;
};

/// Whether both are one surface, to 1e-6 of the smaller radius.
bool same(const CurvedSurface& a, const CurvedSurface& b);
/// The surface after a rigid motion.
CurvedSurface moved(const CurvedSurface& surface, const Motion& motion);
/// The surface after its coordinates are multiplied by a factor > 0.
CurvedSurface scaled(const CurvedSurface& surface, double factor);

/// The name of the boundary that carries a surface, to the last bit; and the surface of such a name, nothing for other names.
std::string name_of(const CurvedSurface& surface);
std::optional<CurvedSurface> curved_surface(const std::string& name);

}  // namespace mortise::mesh
