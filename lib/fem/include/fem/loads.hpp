// Consistent nodal loads. Each function adds to the nodal forces f, unknown d * node + component of the piece; see Kinematics for
// the thickness. None communicates: sums over the ranks are up to the caller.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "fem/materials.hpp"
#include "fem/temperature.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// Area of the facets of a boundary in this piece: in a plane their length times the thickness.
double area(const mesh::Mesh& mesh, int boundary, Kinematics kinematics);

/// A quantity by place.
using ScalarField = std::function<double(const Point&)>;
using VectorField = std::function<Point(const Point&)>;

/// f_i += integral of -p n N_i over the boundary: a positive pressure, force per area, pushes into the body.
void add_pressure(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const ScalarField& pressure, Eigen::VectorXd& f);
void add_pressure(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, double pressure, Eigen::VectorXd& f);

/// f_i += integral of t N_i over the boundary, t a force per area.
void add_traction(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const VectorField& traction, Eigen::VectorXd& f);
void add_traction(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const Point& traction, Eigen::VectorXd& f);

/// f_i += integral of density a N_i over all cells.
void add_acceleration(const mesh::Mesh& mesh, Kinematics kinematics, const Materials& materials, const VectorField& acceleration,
                      Eigen::VectorXd& f);
void add_acceleration(const mesh::Mesh& mesh, Kinematics kinematics, const Materials& materials, const Point& acceleration,
                      Eigen::VectorXd& f);
/// The same for one density.
void add_acceleration(const mesh::Mesh& mesh, Kinematics kinematics, double density, const Point& acceleration,
                      Eigen::VectorXd& f);

/// f_i += integral of B_i' D e over all cells, where e is the thermal expansion times `temperature_change` along every axis, also
/// across a plane: what a body feels that would expand by it if nothing held it. A temperature that varies is taken at the
/// integration points, in cells of first order as the mean of the cell: their strains are constant, and a strain that is not
/// would leave stresses of its own. Not so with incompatible modes, which bend as a temperature makes them that varies across:
/// their expansion is eliminated as they are.
void add_expansion(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                   const Temperature& temperature_change, Eigen::VectorXd& f, Formulation formulation = Formulation::standard);

/// Integrals over the facets of a boundary in this piece, x measured from an origin: far from the boundary, x x' loses it.
struct Moments {
  double area = 0;                                   ///< as area()
  Point first = Point::Zero();                       ///< of x
  Point normal = Point::Zero();                      ///< of the outward normal
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< of x x'
};
/// Of one boundary.
Moments moments(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const Point& origin = Point::Zero());

/// An integration point of a boundary's facet: the facet's nodes, their shape functions there, and the area that the point stands
/// for times the outward normal.
using BoundaryVisitor = std::function<void(std::span<const Local> nodes, const Eigen::VectorXd& shape, const Point& area)>;
/// Visits the integration points of all facets of a boundary, of rules that are exact for products of two shape functions on
/// plane facets.
void for_each_point_of_boundary(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const BoundaryVisitor& visit);

/// 4 x nodes of the piece: column n has the integrals of N_n and of N_n x over the boundary, x measured from `origin`.
Eigen::MatrixXd nodal_moments(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const Point& origin);

}  // namespace mortise::fem
