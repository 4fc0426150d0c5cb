// What gmsh knows of the shape of the faces that it meshed.
#pragma once

namespace mortise::mesh {

/// Puts every face (plane models: curve) of gmsh's model that is a part of a cylinder, cone or sphere (circle) into a physical
/// group whose name says so; see mesh/curved_surface.hpp. The model is meshed.
void mark_curved_surfaces(int dimension);

}  // namespace mortise::mesh
