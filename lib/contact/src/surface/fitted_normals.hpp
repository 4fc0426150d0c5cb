// Normals that do not depend on how a curved surface is cut into faces.
#pragma once

#include "surface/surface_nodes.hpp"

namespace mortise::contact {

/// Turns the normals n of the surface nodes of a side in space into those of the surface of second order next to the nodes x_j
/// round each: with d = x_j - x and z = d.n, 2 z = d'C d + k z^2 with C a symmetric matrix in the tangent plane and k its larger
/// eigenvalue, in the least squares of both sides over d^2 [after Cazals and Pouget, Comput. Aided Geom. Des. 22 (2005), who have
/// no z^2]. Exact where the nodes lie on a sphere or a cylinder, whatever the faces are. Elsewhere a surface of third order takes
/// its place, through the nodes round those as well, or at a border and next to few nodes that of a cone, where these leave far
/// less; see normal_of_third_order() and normal_of_cone(). Means of the normals of faces are wrong there by as much as a tenth of
/// the angle between two faces, and gaps by as much of the sagitta. Where the nodes are plane, normals are the `means`; where
/// nothing of second order goes through them, they stay. At a `border`, and where less than six nodes lie round one, the nodes
/// round those count as well.
///
/// Where such a surface leaves more than a fifth of the heights of the nodes round one and round those: if two of them that meet
/// in a line from node to node, with one tangent plane and curvatures of their own across it, leave a twentieth, and the next
/// node of the line says the same, the normal is theirs. A cylinder runs into a fillet there, or one arc into another.
void fit_normals(const Side& side, const SurfaceNodes& means, const std::vector<bool>& border, SurfaceNodes& surface_nodes);

}  // namespace mortise::contact
