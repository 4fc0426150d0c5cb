#include "formulation.hpp"

#include <Eigen/Dense>

#include "base/dense.hpp"
#include "tensor.hpp"

namespace mortise::fem {

namespace {

// Mean of the gradients of the shape functions over the cell, unknown d * node + component, and its volume.
std::pair<Eigen::VectorXd, double> mean_gradient(const CellGeometry& cell, int d)
{
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cell.element().nodes) * d);
  double volume = 0;
  for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
    volume += cell.volumes()[q];
    for (int i = 0; i < cell.element().nodes; ++i)
      for (int a = 0; a < d; ++a)
        mean[i * d + a] += cell.volumes()[q] * (cell.gradient(q)(i, a) + (a == 0 && cell.axisymmetric() ? cell.hoop(q)[i] : 0));
  }
  return {mean / volume, volume};
}

// Adds what the hoop strain h_i u_i contributes to the stiffness of a cell: with the gradients g_i, of radial components,
// integral of lambda (h_i g_j + g_i h_j) + (lambda + 2 mu) h_i h_j.
void add_hoop(const CellGeometry& cell, const Lame& constants, Eigen::Map<Eigen::MatrixXd>& k)
{
  const int n = cell.element().nodes;
  const auto& [lambda, mu] = constants;
  for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
    const auto g = cell.gradient(q);
    const auto h = cell.hoop(q);
    const double volume = cell.volumes()[q];
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        k(2 * i, 2 * j) += volume * (lambda * (h[i] * g(j, 0) + g(i, 0) * h[j]) + (lambda + 2 * mu) * h[i] * h[j]);
        k(2 * i, 2 * j + 1) += volume * lambda * h[i] * g(j, 1);
        k(2 * i + 1, 2 * j) += volume * lambda * g(i, 1) * h[j];
      }
  }
}

// The integral of B' C B.
void add_orthotropic(const CellGeometry& cell, const Elasticity& elasticity, Eigen::Map<Eigen::MatrixXd>& k)
{
  k.setZero();
  for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
    const auto b = strain_matrix(cell.gradient(q), cell.axisymmetric() ? cell.hoop(q).data() : nullptr);
    k += cell.volumes()[q] * b.transpose() * elasticity.stiffness(place_of(cell, q)) * b;
  }
}

// H = sum over the nodes of u g', d x d.
template <int d>
void displacement_gradient(const CellGeometry& cell, const Eigen::MatrixXd& displacement, std::size_t q, Eigen::Matrix3d& h)
{
  const auto gradient = cell.gradient(q);
  const double* u = displacement.data();
  const double* g = gradient.data();
  const Eigen::Index n = gradient.rows();
  double sum[d][d] = {};
  for (Eigen::Index i = 0; i < n; ++i)
    for (int b = 0; b < d; ++b)
      for (int a = 0; a < d; ++a) sum[b][a] += u[i * d + a] * g[b * n + i];
  for (int b = 0; b < d; ++b)
    for (int a = 0; a < d; ++a) h(a, b) = sum[b][a];
}

}  // namespace

// The stiffness of nodes and modes together, from `enriched_`, which it fills.
Eigen::MatrixXd CellFormulation::enriched_stiffness(const CellGeometry& cell)
{
  const Element& element = cell.element();
  const Eigen::Index n = element.nodes, d = dimension_;
  const Eigen::Map<const Eigen::MatrixXd> x(cell.coordinates().data(), n, d);
  const Eigen::MatrixXd centre = x.transpose() * element.centre_gradient;  // dx / dxi there
  const Eigen::MatrixXd inverse = dense::inverse(centre);
  const double determinant = dense::determinant(centre);
  enriched_.resize(element.points() * static_cast<std::size_t>((n + d) * d));
  for (std::size_t q = 0; q < element.points(); ++q) {
    Eigen::Map<Eigen::MatrixXd> all(enriched_.data() + q * static_cast<std::size_t>((n + d) * d), n + d, d);
    all.topRows(n) = cell.gradient(q);
    const double ratio = determinant * element.weight[q] / cell.volumes()[q];
    for (Eigen::Index k = 0; k < d; ++k) all.row(n + k) = -2 * element.point[q][k] * ratio * inverse.row(k);
  }
  Eigen::MatrixXd k((n + d) * d, (n + d) * d);
  if (elasticity_.orthotropic()) {
    k.setZero();
    for (std::size_t q = 0; q < element.points(); ++q) {
      const Eigen::Map<const Eigen::MatrixXd> all(enriched_.data() + q * static_cast<std::size_t>((n + d) * d), n + d, d);
      const auto b = strain_matrix(all);
      k += cell.volumes()[q] * b.transpose() * elasticity_.stiffness(place_of(cell, q)) * b;
    }
    return k;
  }
  const auto& [lambda, mu] = elasticity_.lame();
  element.stiffness_with_modes(element, enriched_.data(), cell.volumes().data(), lambda, mu, k.data());
  return k;
}

// What hoop strains, which `result_` has, push the modes with.
void CellFormulation::add_hoop_forces(const CellGeometry& cell, Eigen::VectorXd& forces) const
{
  const Eigen::Index n = cell.element().nodes, d = dimension_;
  for (std::size_t q = 0; q < result_.size(); ++q) {
    const Eigen::Map<const Eigen::MatrixXd> gradient(enriched_.data() + q * static_cast<std::size_t>((n + d) * d), n + d, d);
    Eigen::Matrix3d hoop = Eigen::Matrix3d::Zero();
    hoop(2, 2) = result_[q](2, 2);
    const Tensor stress = tensor(elasticity_.stress(hoop, 0, place_of(cell, q)));
    forces.reshaped(d, d) += cell.volumes()[q] * stress.topLeftCorner(d, d) * gradient.bottomRows(d).transpose();
  }
}

// f_m: the integral of the modes' gradients times the stress that takes the expansion back.
Eigen::VectorXd CellFormulation::expansion_of_modes(const CellGeometry& cell, std::span<const double> warmer) const
{
  const Eigen::Index n = cell.element().nodes, d = dimension_;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(d * d);
  for (std::size_t q = 0; q < warmer.size(); ++q) {
    const Eigen::Map<const Eigen::MatrixXd> gradient(enriched_.data() + q * static_cast<std::size_t>((n + d) * d), n + d, d);
    const Tensor stress = tensor(elasticity_.stress(Eigen::Matrix3d::Zero(), -warmer[q], place_of(cell, q)));
    result.reshaped(d, d) += cell.volumes()[q] * stress.topLeftCorner(d, d) * gradient.bottomRows(d).transpose();
  }
  return result;
}

Eigen::VectorXd CellFormulation::forces_of_modes(const CellGeometry& cell, std::span<const double> warmer)
{
  const Eigen::MatrixXd all = enriched_stiffness(cell);
  const Eigen::Index modes = dimension_ * dimension_;
  return all.topRightCorner(all.rows() - modes, modes) *
         dense::solve_symmetric(all.bottomRightCorner(modes, modes), expansion_of_modes(cell, warmer));
}

void CellFormulation::stiffness(const CellGeometry& cell, std::vector<double>& k)
{
  const Element& element = cell.element();
  const Eigen::Index size = static_cast<Eigen::Index>(element.nodes) * dimension_;
  k.resize(static_cast<std::size_t>(size * size));
  Eigen::Map<Eigen::MatrixXd> matrix(k.data(), size, size);
  const auto& [lambda, mu] = elasticity_.lame();
  switch (formulation_) {
    case Formulation::standard:
      if (elasticity_.orthotropic()) return add_orthotropic(cell, elasticity_, matrix);
      element.stiffness(element, cell.gradients().data(), cell.volumes().data(), lambda, mu, k.data());
      if (cell.axisymmetric()) add_hoop(cell, elasticity_.lame(), matrix);
      return;
    case Formulation::bbar: {
      element.stiffness(element, cell.gradients().data(), cell.volumes().data(), -2 * mu / 3, mu, k.data());
      if (cell.axisymmetric()) add_hoop(cell, {-2 * mu / 3, mu}, matrix);
      const auto [mean, volume] = mean_gradient(cell, dimension_);
      matrix += (lambda + 2 * mu / 3) * volume * mean * mean.transpose();
      return;
    }
    case Formulation::incompatible: {
      const Eigen::MatrixXd all = enriched_stiffness(cell);
      const Eigen::Index modes = all.rows() - size;
      matrix = all.topLeftCorner(size, size) -
               all.topRightCorner(size, modes) *
                   dense::solve_symmetric(all.bottomRightCorner(modes, modes), all.bottomLeftCorner(modes, size));
      matrix = (0.5 * (matrix + matrix.transpose())).eval();
      return;
    }
  }
}

const std::vector<Eigen::Matrix3d>& CellFormulation::gradients(const CellGeometry& cell, const Eigen::MatrixXd& displacement,
                                                               std::span<const double> warmer)
{
  const Eigen::Index n = cell.element().nodes, d = dimension_;
  result_.assign(cell.volumes().size(), Eigen::Matrix3d::Zero());
  for (std::size_t q = 0; q < result_.size(); ++q) {
    d == 2 ? displacement_gradient<2>(cell, displacement, q, result_[q])
           : displacement_gradient<3>(cell, displacement, q, result_[q]);
    if (cell.axisymmetric()) result_[q](2, 2) = displacement.row(0).dot(cell.hoop(q));
  }
  if (formulation_ == Formulation::bbar) {
    const double mean = mean_gradient(cell, dimension_).first.dot(displacement.reshaped());
    for (auto& h : result_) h.diagonal().array() += (mean - h.trace()) / 3;
  } else if (formulation_ == Formulation::incompatible) {
    const Eigen::MatrixXd all = enriched_stiffness(cell);
    const Eigen::Index modes = d * d;
    Eigen::VectorXd forces = all.bottomLeftCorner(modes, n * d) * displacement.reshaped();
    forces -= expansion_of_modes(cell, warmer);
    if (cell.axisymmetric()) add_hoop_forces(cell, forces);
    const Eigen::VectorXd amplitudes = -dense::solve_symmetric(all.bottomRightCorner(modes, modes), forces);
    for (std::size_t q = 0; q < result_.size(); ++q) {
      const Eigen::Map<const Eigen::MatrixXd> gradient(enriched_.data() + q * static_cast<std::size_t>((n + d) * d), n + d, d);
      result_[q].topLeftCorner(d, d) += amplitudes.reshaped(d, d) * gradient.bottomRows(d);
    }
  }
  return result_;
}

}  // namespace mortise::fem
