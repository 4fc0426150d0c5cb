#include "elasticity.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "base/error.hpp"
#include "tensor.hpp"

namespace mortise::fem {

namespace {

// T of local strain = T strain, shear strains as angles.
Elasticity::Matrix strain_rotation(const Eigen::Matrix3d& axes)
{
  Elasticity::Matrix t;
  for (int j = 0; j < 6; ++j) {
    Stress unit = Stress::Unit(j);
    unit.tail<3>() /= 2;
    t.col(j) = entries(axes * tensor(unit) * axes.transpose());
    t.col(j).tail<3>() *= 2;
  }
  return t;
}

}  // namespace

Stress strain_of(const Eigen::Matrix3d& h)
{
  Stress strain = entries(h + h.transpose());
  strain.head<3>() /= 2;
  return strain;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> strain_matrix(const Eigen::Ref<const Eigen::MatrixXd>& gradients, const double* hoop)
{
  const auto d = gradients.cols();
  Eigen::Matrix<double, 6, Eigen::Dynamic> b = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, d * gradients.rows());
  for (Eigen::Index i = 0; i < gradients.rows(); ++i) {
    const auto g = gradients.row(i);
    for (Eigen::Index a = 0; a < d; ++a) b(a, d * i + a) = g[a];
    b(3, d * i) = g[1], b(3, d * i + 1) = g[0];
    if (d == 3) {
      b(4, d * i + 1) = g[2], b(4, d * i + 2) = g[1];
      b(5, d * i) = g[2], b(5, d * i + 2) = g[0];
    } else if (hoop != nullptr) {
      b(2, d * i) = hoop[i];
    }
  }
  return b;
}

Point place_of(const CellGeometry& cell, std::size_t q)
{
  const auto n = static_cast<Eigen::Index>(cell.element().nodes);
  const auto d = static_cast<Eigen::Index>(cell.coordinates().size()) / n;
  const Eigen::Map<const Eigen::MatrixXd> x(cell.coordinates().data(), n, d);
  Point place = Point::Zero();
  place.head(d) = x.transpose() * cell.element().shape[q].head(n);
  return place;
}

Elasticity::Elasticity(const Material& material, Kinematics kinematics) : material_(material), kinematics_(kinematics)
{
  if (!orthotropic()) {
    lame_ = fem::lame(material, kinematics);
    return;
  }
  const auto& m = *material.orthotropic;
  flexibility_ = fem::flexibility(m);
  local_.topLeftCorner<3, 3>() = flexibility_.inverse();
  local_(3, 3) = m.shear_modulus[0];  // 12
  local_(4, 4) = m.shear_modulus[2];  // 23
  local_(5, 5) = m.shear_modulus[1];  // 13
  if (uniform()) everywhere_ = stiffness(Point::Zero());
}

Eigen::Matrix3d Elasticity::axes(const Point& x) const
{
  if (!material_.directions) return Eigen::Matrix3d::Identity();
  const auto found = material_.directions->at(x);
  if (!found)
    throw Error(ExitStatus::bad_input,
                fmt::format("({:.6g}, {:.6g}, {:.6g}) lies on the axis of its material's directions, where radial means nothing; "
                            "leave a hole round the axis, or take another material there",
                            x[0], x[1], x[2]));
  return *found;
}

Elasticity::Matrix Elasticity::stiffness(const Point& x) const
{
  if (everywhere_) return *everywhere_;
  const Matrix t = strain_rotation(axes(x));
  Matrix c = t.transpose() * local_ * t;
  if (kinematics_ == Kinematics::plane_stress) {
    const Stress column = c.col(2);
    c -= column * column.transpose() / c(2, 2);
    c.row(2).setZero();
    c.col(2).setZero();
  }
  return c;
}

Stress Elasticity::expansion(const Point& x) const
{
  const auto& m = *material_.orthotropic;
  if (!m.thermal_expansion) return material_.thermal_expansion * (Stress() << 1, 1, 1, 0, 0, 0).finished();
  const Eigen::Matrix3d r = axes(x);
  const Eigen::Vector3d local(m.thermal_expansion->data());
  Stress result = entries(r.transpose() * local.asDiagonal() * r);
  result.tail<3>() *= 2;
  return result;
}

double Elasticity::complementary(const Stress& s, const Point& x) const
{
  if (!orthotropic()) {
    const double nu = material_.poisson_ratio;
    const double trace = s.head<3>().sum(), product = s.head<3>().squaredNorm() + 2 * s.tail<3>().squaredNorm();
    return ((1 + nu) * product - nu * trace * trace) / material_.young_modulus;
  }
  const Eigen::Matrix3d r = axes(x);
  const Stress local = entries(r * tensor(s) * r.transpose());
  return local.head<3>().dot(flexibility_ * local.head<3>()) + local[3] * local[3] / local_(3, 3) +
         local[4] * local[4] / local_(4, 4) + local[5] * local[5] / local_(5, 5);
}

Stress Elasticity::stress(const Eigen::Matrix3d& h, double warmer, const Point& x) const
{
  if (orthotropic()) {
    Stress strain = strain_of(h);
    if (warmer != 0) strain -= warmer * expansion(x);
    return stiffness(x) * strain;
  }
  Eigen::Matrix3d strain = 0.5 * (h + h.transpose());
  strain.diagonal().head(kinematics_ == Kinematics::plane_stress ? 2 : 3).array() -= material_.thermal_expansion * warmer;
  Eigen::Matrix3d s = lame_.lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * lame_.mu * strain;
  if (kinematics_ == Kinematics::plane_stress) s(2, 2) = 0;
  return entries(s);
}

}  // namespace mortise::fem
