#include "bem/surface_stress.hpp"

namespace mortise::bem {

Point traction(const fem::Stress& s, const Point& n)
{
  return {s[0] * n[0] + s[3] * n[1] + s[5] * n[2], s[3] * n[0] + s[1] * n[1] + s[4] * n[2],
          s[5] * n[0] + s[4] * n[1] + s[2] * n[2]};
}

Eigen::MatrixXd panel_stresses(const Panels& panels, const fem::Material& material, const Eigen::VectorXd& u,
                               const Eigen::VectorXd& t)
{
  const double mu = material.young_modulus / (2 * (1 + material.poisson_ratio));
  const double lambda = 2 * mu * material.poisson_ratio / (1 - 2 * material.poisson_ratio);
  Eigen::MatrixXd result(panels.size(), 6);
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    const Point& n = panels.normal[p];
    const Point traction = t.segment<3>(3 * row);
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k)
      gradient += u.segment<3>(3 * panels.corners[p][static_cast<std::size_t>(k)]) * panels.gradient(p, k).transpose();
    const double normal = traction.dot(n);
    const Point along = (traction - normal * n) / mu - gradient.transpose() * n;
    const Point across = along + (normal - lambda * gradient.trace()) / (lambda + 2 * mu) * n;
    gradient += across * n.transpose();
    const Eigen::Matrix3d s = mu * (gradient + gradient.transpose()) + lambda * gradient.trace() * Eigen::Matrix3d::Identity();
    result.row(row) << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
  }
  return result;
}

}  // namespace mortise::bem
