#include "bem/particular_solution.hpp"

#include "bem/surface_stress.hpp"

namespace mortise::bem {

ParticularSolution::ParticularSolution(const fem::Constitution& constitution, const Point& centre) : centre_(centre)
{
  const auto& material = constitution.materials[0];
  const double nu = material.poisson_ratio, mu = material.young_modulus / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
  const Point force = material.density * constitution.acceleration;
  expansion_ = material.thermal_expansion * constitution.temperature_change;
  force_ = force.norm();
  direction_ = force_ > 0 ? Point(force / force_) : Point::UnitX();
  constrained_ = lambda + 2 * mu;
  along_ = -1;
  across_ = -lambda / constrained_;
}

Point ParticularSolution::displacement(const Point& x) const
{
  const double s = direction_.dot(x - centre_);
  return expansion_ * (x - centre_) - force_ * s * s / (2 * constrained_) * direction_;
}

fem::Stress ParticularSolution::stress(const Point& x) const
{
  const double s = force_ * direction_.dot(x - centre_);
  const Eigen::Matrix3d tensor =
      s * (across_ * Eigen::Matrix3d::Identity() + (along_ - across_) * direction_ * direction_.transpose());
  return (fem::Stress() << tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(1, 2), tensor(0, 2)).finished();
}

Eigen::VectorXd ParticularSolution::displacement(const Panels& panels) const
{
  Eigen::VectorXd u(3 * panels.node_count());
  for (Eigen::Index n = 0; n < panels.node_count(); ++n)
    u.segment<3>(3 * n) = displacement(panels.points[static_cast<std::size_t>(n)]);
  return u;
}

Eigen::VectorXd ParticularSolution::displacement_of_force(const Panels& panels) const
{
  return displacement(panels) - linear_field(panels, Point::Zero(), expansion_ * Eigen::Matrix3d::Identity(), centre_);
}

Eigen::VectorXd ParticularSolution::traction(const Panels& panels) const
{
  Eigen::VectorXd t(3 * panels.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    t.segment<3>(3 * static_cast<Eigen::Index>(p)) =
        bem::traction(stress((panels.corner(p, 0) + panels.corner(p, 1) + panels.corner(p, 2)) / 3), panels.normal[p]);
  return t;
}

// Tractions are linear on a panel: the mass matrix of a triangle, area / 12 (1 + delta_ij), is exact.
Eigen::VectorXd ParticularSolution::nodal_forces(const Panels& panels) const
{
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * panels.node_count());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    std::array<Point, 3> t;
    for (int k = 0; k < 3; ++k) t[static_cast<std::size_t>(k)] = bem::traction(stress(panels.corner(p, k)), panels.normal[p]);
    for (std::size_t k = 0; k < 3; ++k)
      f.segment<3>(3 * panels.corners[p][k]) += panels.area[p] / 12 * (t[0] + t[1] + t[2] + t[k]);
  }
  return f;
}

// b^2 s^2 / (2 (lambda + 2 mu)), s = (x - c).direction, whose integral over the inside is that of s^3 / 3 n.direction over the
// surface: the corners' monomials of degree 3 on a triangle [Strang and Fix 1973].
double ParticularSolution::strain_energy(const Panels& panels) const
{
  double sum = 0;
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    std::array<double, 3> s;
    for (int k = 0; k < 3; ++k) s[static_cast<std::size_t>(k)] = direction_.dot(panels.corner(p, k) - centre_);
    double cubic = 0;  // the complete homogeneous polynomial of degree 3: the mean of s^3 is a tenth of it
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j)
        for (std::size_t k = j; k < 3; ++k) cubic += s[i] * s[j] * s[k];
    sum += panels.area[p] * panels.normal[p].dot(direction_) * cubic / 30;
  }
  return force_ * force_ / (2 * constrained_) * sum;
}

}  // namespace mortise::bem
