#include "bem/surface_stress.hpp"

#include <numbers>

namespace mortise::bem {

namespace {

struct Lame {
  double mu, lambda;
};
Lame lame(const fem::Material& material)
{
  const double nu = material.poisson_ratio, mu = material.young_modulus / (2 * (1 + nu));
  return {mu, 2 * mu * nu / (1 - 2 * nu)};
}

}  // namespace

fem::Stress components(const Eigen::Matrix3d& s)
{
  return (fem::Stress() << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)).finished();
}

Point traction(const fem::Stress& s, const Point& n)
{
  return {s[0] * n[0] + s[3] * n[1] + s[5] * n[2], s[3] * n[0] + s[1] * n[1] + s[4] * n[2],
          s[5] * n[0] + s[4] * n[1] + s[2] * n[2]};
}

Eigen::Matrix3d hooke(const fem::Material& material, const Eigen::Matrix3d& gradient)
{
  const auto [mu, lambda] = lame(material);
  return mu * (gradient + gradient.transpose()) + lambda * gradient.trace() * Eigen::Matrix3d::Identity();
}

template <int D>
Eigen::Matrix3d panel_gradient(const PanelsIn<D>& panels, const fem::Material& material, std::size_t panel,
                               const Eigen::VectorXd& u, const Eigen::VectorXd& t)
{
  const auto [mu, lambda] = lame(material);
  const Point &n = panels.normal[panel], force = lifted<D>(t.segment<D>(D * static_cast<Eigen::Index>(panel)));
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  for (int k = 0; k < D; ++k)
    gradient +=
        lifted<D>(u.segment<D>(D * panels.corners[panel][static_cast<std::size_t>(k)])) * panels.gradient(panel, k).transpose();
  const Point tangential = force / mu - gradient.transpose() * n;
  const double normal = (force.dot(n) - lambda * gradient.trace()) / (lambda + 2 * mu);
  return gradient + (tangential - n.dot(tangential) * n + normal * n) * n.transpose();
}
template Eigen::Matrix3d panel_gradient(const PanelsIn<2>&, const fem::Material&, std::size_t, const Eigen::VectorXd&,
                                        const Eigen::VectorXd&);
template Eigen::Matrix3d panel_gradient(const PanelsIn<3>&, const fem::Material&, std::size_t, const Eigen::VectorXd&,
                                        const Eigen::VectorXd&);

template <int D>
Eigen::MatrixXd panel_stresses(const PanelsIn<D>& panels, const fem::Material& material, const Eigen::VectorXd& u,
                               const Eigen::VectorXd& t)
{
  Eigen::MatrixXd result(panels.size(), 6);
  for (Eigen::Index p = 0; p < panels.size(); ++p)
    result.row(p) = components(hooke(material, panel_gradient(panels, material, static_cast<std::size_t>(p), u, t)));
  return result;
}
template Eigen::MatrixXd panel_stresses(const PanelsIn<2>&, const fem::Material&, const Eigen::VectorXd&, const Eigen::VectorXd&);
template Eigen::MatrixXd panel_stresses(const PanelsIn<3>&, const fem::Material&, const Eigen::VectorXd&, const Eigen::VectorXd&);

Eigen::VectorXd interpolation_errors(const PlanePanels& panels, const fem::Material& material, const Eigen::VectorXd& u,
                                     const Eigen::VectorXd& t)
{
  const double nu = material.poisson_ratio, stiffness = lame(material).mu / (2 * std::numbers::pi * (1 - nu));
  std::vector<Eigen::Matrix3d> gradient, mean(panels.points.size(), Eigen::Matrix3d::Zero());
  std::vector<double> length(panels.points.size(), 0.0);
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    gradient.push_back(panel_gradient(panels, material, p, u, t));
    for (const Local n : panels.corners[p]) {
      mean[static_cast<std::size_t>(n)] += panels.area[p] * gradient.back();
      length[static_cast<std::size_t>(n)] += panels.area[p];
    }
  }
  Eigen::VectorXd result(panels.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p) {
    std::array<Point, 2> off;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto n = static_cast<std::size_t>(panels.corners[p][k]);
      off[k] = (mean[n] / length[n] - gradient[p]) * (panels.area[p] * panels.gradient(p, 1));
    }
    const double square = (off[0].squaredNorm() + off[0].dot(off[1]) + off[1].squaredNorm()) / 3;
    result[static_cast<Eigen::Index>(p)] = stiffness * panels.area[p] * panels.area[p] * square;
  }
  return result;
}

}  // namespace mortise::bem
