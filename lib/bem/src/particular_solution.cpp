#include "bem/particular_solution.hpp"

#include "bem/plane_state.hpp"
#include "bem/surface_stress.hpp"

namespace mortise::bem {

namespace {

// Means over the inside are integrals over the border: a third of the integral of n_direction (x - centre).direction^3.
template <int D>
double integral_of_square(const PanelsIn<D>& panels, const Point& direction, const Point& centre)
{
  constexpr int cubics = D == 3 ? 10 : 4;  // of degree 3: the mean of s^3 is that of the monomials in the corners' s
  double sum = 0;
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    std::array<double, D> s;
    for (int k = 0; k < D; ++k) s[static_cast<std::size_t>(k)] = direction.dot(panels.corner(p, k) - centre);
    double cubic = 0;
    for (std::size_t i = 0; i < D; ++i)
      for (std::size_t j = i; j < D; ++j)
        for (std::size_t k = j; k < D; ++k) cubic += s[i] * s[j] * s[k];
    sum += panels.area[p] * panels.normal[p].dot(direction) * cubic / (3 * cubics);
  }
  return sum;
}

// Of the inside.
double enclosed(const PlanePanels& panels)
{
  double sum = 0;
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    sum += panels.area[p] * panels.normal[p].dot(panels.middle(p) - panels.points.front()) / 2;
  return sum;
}

}  // namespace

ParticularSolution::ParticularSolution(const fem::Constitution& constitution, const Point& centre, fem::Kinematics kinematics)
    : centre_(centre)
{
  const auto material = in_plane(constitution.materials[0], kinematics);
  const double nu = material.poisson_ratio, mu = material.young_modulus / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
  Point force = material.density * constitution.acceleration;
  if (kinematics != fem::Kinematics::solid) force[2] = 0;
  expansion_ = material.thermal_expansion * constitution.temperature_change.uniform;
  force_ = force.norm();
  direction_ = force_ > 0 ? Point(force / force_) : Point::UnitX();
  constrained_ = lambda + 2 * mu;
  along_ = -1;
  across_ = -lambda / constrained_;
  const double across = stress_across_plane(constitution, kinematics, 0);
  across_plane_ = across * across / (2 * constitution.materials[0].young_modulus);
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

template <int D>
Eigen::VectorXd ParticularSolution::displacement(const PanelsIn<D>& panels) const
{
  Eigen::VectorXd u(D * panels.node_count());
  for (Eigen::Index n = 0; n < panels.node_count(); ++n)
    u.segment<D>(D * n) = flattened<D>(displacement(panels.points[static_cast<std::size_t>(n)]));
  return u;
}

template <int D>
Eigen::VectorXd ParticularSolution::displacement_of_force(const PanelsIn<D>& panels) const
{
  return displacement(panels) - linear_field(panels, Point::Zero(), expansion_ * Eigen::Matrix3d::Identity(), centre_);
}

template <int D>
Eigen::VectorXd ParticularSolution::traction(const PanelsIn<D>& panels) const
{
  Eigen::VectorXd t(D * panels.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    t.segment<D>(D * static_cast<Eigen::Index>(p)) = flattened<D>(bem::traction(stress(panels.middle(p)), panels.normal[p]));
  return t;
}

// Tractions are linear on a panel: the mass matrix, area / (D (D + 1)) (1 + delta_ij), is exact.
template <int D>
Eigen::VectorXd ParticularSolution::nodal_forces(const PanelsIn<D>& panels) const
{
  Eigen::VectorXd f = Eigen::VectorXd::Zero(D * panels.node_count());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    std::array<Point, D> t;
    Point sum = Point::Zero();
    for (int k = 0; k < D; ++k)
      sum += t[static_cast<std::size_t>(k)] = bem::traction(stress(panels.corner(p, k)), panels.normal[p]);
    for (std::size_t k = 0; k < D; ++k)
      f.segment<D>(D * panels.corners[p][k]) += panels.area[p] / (D * (D + 1)) * flattened<D>(sum + t[k]);
  }
  return f;
}

// b^2 s^2 / (2 (lambda + 2 mu)), s = (x - c).direction.
template <int D>
double ParticularSolution::strain_energy(const PanelsIn<D>& panels) const
{
  const double of_force = force_ * force_ / (2 * constrained_) * integral_of_square(panels, direction_, centre_);
  if constexpr (D == 2) return of_force + across_plane_ * enclosed(panels);
  return of_force;
}

template Eigen::VectorXd ParticularSolution::displacement(const PanelsIn<2>&) const;
template Eigen::VectorXd ParticularSolution::displacement(const PanelsIn<3>&) const;
template Eigen::VectorXd ParticularSolution::displacement_of_force(const PanelsIn<2>&) const;
template Eigen::VectorXd ParticularSolution::displacement_of_force(const PanelsIn<3>&) const;
template Eigen::VectorXd ParticularSolution::traction(const PanelsIn<2>&) const;
template Eigen::VectorXd ParticularSolution::traction(const PanelsIn<3>&) const;
template Eigen::VectorXd ParticularSolution::nodal_forces(const PanelsIn<2>&) const;
template Eigen::VectorXd ParticularSolution::nodal_forces(const PanelsIn<3>&) const;
template double ParticularSolution::strain_energy(const PanelsIn<2>&) const;
template double ParticularSolution::strain_energy(const PanelsIn<3>&) const;

}  // namespace mortise::bem
