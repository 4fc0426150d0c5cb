// Rigid motions of whole bodies that no support or contact row feels: the spin of a frictionless roller, a block on a smooth
// table.
#pragma once

#include <string>
#include <vector>

#include "constraint/sliding_surface.hpp"
#include "feti/coarse_problem.hpp"

namespace mortise::feti {

/// v(x) = translation + rotation x (x - centre), of one body.
struct RigidMotion {
  int body = 0;
  Point centre = Point::Zero();
  Point translation = Point::Zero();
  Point rotation = Point::Zero();

  /// v(x).
  Point at(const Point& x) const { return translation + rotation.cross(x - centre); }
};

/// "rotates about the axis through (..) along (..)" or "moves along (..)"; `size` is a length of the body.
std::string describe(const RigidMotion& motion, double size);

/// The place of each body, the same on every rank.
struct BodyFrame {
  Point centre = Point::Zero();                        ///< mean of its nodes
  double radius = 1;                                   ///< root mean square distance of its nodes from there
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< principal axes of its nodes, as columns
  Point arms = Point::Ones();                          ///< root mean square distance of its nodes from each axis
};
/// One for each body of the catalogue. Collective.
std::vector<BodyFrame> body_frames(const partition::Decomposition& decomposition, const Communicator& comm);

/// The rigid motion of the body that is nearest, by least squares, to `coordinates` (of the kernels of all clusters). Collective.
RigidMotion rigid_part(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                       const BodyFrame& frame, int body, const Eigen::VectorXd& coordinates, const Communicator& comm);

/// A set of bodies that move together; |v| is at most about 1 on each.
struct FreeMotion {
  std::vector<RigidMotion> motions;
  double resistance = 0;  ///< the largest |row . v| over all rows, 0 for a motion that is exactly free
  /// Surfaces in contact slide along themselves: rows feel nothing of it but the facets of the mesh.
  bool sliding = false;
  /// If surfaces slide along themselves, whether rows feel facets or not: the height of a facet's arc over its radius, root mean
  /// square.
  double sagitta = 0;
  double turning = 0;  ///< rotation times the body's size over the velocity of its centre; of several bodies the largest
  double work = 0;     ///< of loads and preloads on it, over `force`
  double force = 0;    ///< sum of |nodal forces| and preloads on its bodies
};

/// Finds them from the support and contact rows of `jump` (G of coarse_rows): body by body, with all other bodies at rest, where
/// also motions count that let surfaces slide along themselves, whatever their facets resist, and those that are nearly free
/// (every row feels less than a few per cent of them); then those of several bodies together, which must be exactly free. A
/// pretension section that is tightened to a force lets its two sides move towards each other. Collective.
std::vector<FreeMotion> find_free_motions(const partition::Decomposition& decomposition, const JumpOperator& jump,
                                          const Clusters& clusters, fem::Kinematics kinematics, const SparseMatrix& g,
                                          const constraint::Constraints& constraints, std::span<const Unknown> unknowns,
                                          std::span<const constraint::SlidingSurface> sliding_surfaces,
                                          const std::vector<Eigen::VectorXd>& load, const Communicator& comm);

/// The motion with FreeMotion::work and force of other loads, without preloads. Collective.
FreeMotion loaded_by(FreeMotion motion, const partition::Decomposition& decomposition, const std::vector<Eigen::VectorXd>& load,
                     const Communicator& comm);

}  // namespace mortise::feti
