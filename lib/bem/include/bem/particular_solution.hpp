// Displacements of an elastic space under a constant body force b and a constant change of temperature:
//
//     u_p = alpha dT (x - c) - (x - c).b b / (2 (lambda + 2 mu)) (x - c).b / b.b,     div sigma(u_p) = -b
//
// What boundary elements find is the rest, u - u_p, which has neither: f = S (u - u_p) + integral of t_p phi.
#pragma once

#include <Eigen/Core>

#include "bem/panels.hpp"
#include "fem/constitution.hpp"
#include "fem/stress.hpp"

namespace mortise::bem {

class ParticularSolution {
 public:
  /// Zero at `centre`. Of one material; forces a volume are its density times the acceleration.
  ParticularSolution(const fem::Constitution& constitution, const Point& centre);

  bool is_zero() const { return expansion_ == 0 && force_ == 0; }
  Point displacement(const Point& x) const;
  /// Without that which the free expansion would need: that has none.
  fem::Stress stress(const Point& x) const;
  /// At the nodes, 3 n.
  Eigen::VectorXd displacement(const Panels& panels) const;
  /// The part of the force alone, which strains the body elastically.
  Eigen::VectorXd displacement_of_force(const Panels& panels) const;
  /// Means over the panels, 3 m.
  Eigen::VectorXd traction(const Panels& panels) const;
  /// Integral of t_p phi, 3 n.
  Eigen::VectorXd nodal_forces(const Panels& panels) const;
  /// Integral of sigma(u_p) : e(u_p) / 2 over the inside.
  double strain_energy(const Panels& panels) const;

 private:
  Point centre_, direction_;
  double expansion_;       // strain
  double force_;           // a volume, along the direction
  double along_, across_;  // stress along the direction and across it, of a unit of force_ * distance
  double constrained_;     // lambda + 2 mu
};

}  // namespace mortise::bem
