// Consistent nodal loads. Each function adds to f, unknown d * node + component of the piece; 2D: per unit thickness.
#pragma once

#include <Eigen/Core>

#include "mesh/mesh.hpp"

namespace mortise::fem {

/// Area (2D: length) of the facets of a boundary in this piece.
double area(const mesh::Mesh& mesh, int boundary, int dimension);

/// f_i += integral of -p n N_i over the boundary: pressure pushes into the body.
void add_pressure(const mesh::Mesh& mesh, int boundary, int dimension, double pressure, Eigen::VectorXd& f);

/// f_i += integral of t N_i over the boundary.
void add_traction(const mesh::Mesh& mesh, int boundary, int dimension, const Point& traction, Eigen::VectorXd& f);

/// f_i += integral of density a N_i over all cells.
void add_acceleration(const mesh::Mesh& mesh, int dimension, double density, const Point& acceleration, Eigen::VectorXd& f);

}  // namespace mortise::fem
