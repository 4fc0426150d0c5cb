// Displacements of an elastic space under a constant body force b and a constant change of temperature:
//
//     u_p = alpha dT (x - c) - (x - c).b b / (2 (lambda + 2 mu)) (x - c).b / b.b,     div sigma(u_p) = -b
//
// What boundary elements find is the rest, u - u_p, which has neither: f = S (u - u_p) + integral of t_p phi. In planes with the
// material of plane_state.hpp.
#pragma once

#include <Eigen/Core>

#include "bem/panels.hpp"
#include "fem/constitution.hpp"
#include "fem/stress.hpp"

namespace mortise::bem {

/// Vectors at nodes and on panels are as of PanelsIn: n nodes, m panels, D components.
class ParticularSolution {
 public:
  /// Zero at `centre`. For a single material; the force per volume is its density times the acceleration, in a plane model the
  /// part of that which lies in the plane.
  ParticularSolution(const fem::Constitution& constitution, const Point& centre,
                     fem::Kinematics kinematics = fem::Kinematics::solid);

  /// Whether there is neither a force per volume nor an expansion.
  bool is_zero() const { return expansion_ == 0 && force_ == 0; }
  /// u_p at a point, a length.
  Point displacement(const Point& x) const;
  /// Of the force alone, since what expands freely has no stress. In a plane model that of in_plane()'s material in plane strain.
  fem::Stress stress(const Point& x) const;
  /// u_p at the nodes, D n.
  template <int D>
  Eigen::VectorXd displacement(const PanelsIn<D>& panels) const;
  /// Its part from the force, which strains the body elastically, at the nodes, D n.
  template <int D>
  Eigen::VectorXd displacement_of_force(const PanelsIn<D>& panels) const;
  /// t_p, forces per area, means over the panels, D m.
  template <int D>
  Eigen::VectorXd traction(const PanelsIn<D>& panels) const;
  /// Integral of t_p phi, forces, D n; in a plane model per thickness.
  template <int D>
  Eigen::VectorXd nodal_forces(const PanelsIn<D>& panels) const;
  /// Integral of sigma(u_p) : e(u_p) / 2 over the inside, and in plane strain of what the held expansion across the plane adds to
  /// the energy of any displacement.
  template <int D>
  double strain_energy(const PanelsIn<D>& panels) const;

 private:
  Point centre_, direction_;
  double expansion_;       // strain
  double force_;           // a volume, along the direction
  double along_, across_;  // stress along the direction and across it, of a unit of force_ * distance
  double constrained_;     // lambda + 2 mu
  double across_plane_;    // energy an area of the expansion across the plane
};

}  // namespace mortise::bem
