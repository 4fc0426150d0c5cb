// What is done for every cell of a mesh, compiled for fixed sizes so that nothing is allocated and the compiler can vectorise.
#pragma once

#include <Eigen/Dense>
#include <array>

#include "fem/element.hpp"

namespace mortise::fem {

template <int n, int d>
void gradients_in_space(const Element& element, const double* x, double* gradients, double* volumes)
{
  using Table = Eigen::Matrix<double, n, d>;
  const Eigen::Map<const Table> nodes(x);
  for (std::size_t q = 0; q < element.points(); ++q) {
    const Eigen::Map<const Table> reference(element.gradient[q].data());
    const Eigen::Matrix<double, d, d> jacobian = nodes.transpose().lazyProduct(reference);  // dx / dxi
    Eigen::Map<Table>(gradients + q * n * d) = reference.lazyProduct(jacobian.inverse().eval());
    volumes[q] = jacobian.determinant() * element.weight[q];
  }
}

// With s_ab = sum over q of volume g_a g_b', n x n, of the components a and b of the gradients, component block ab of K is
// lambda s_ab + mu s_ab' + [a = b] mu (s_11 + .. + s_dd). The blocks of components are what vectorises; K itself goes node by
// node.
template <int n, int d>
void stiffness_of_cell(const Element& element, const double* gradients, const double* volumes, double lambda, double mu,
                       double* k)
{
  using Block = Eigen::Matrix<double, n, n>;
  std::array<std::array<Block, d>, d> s;
  for (int a = 0; a < d; ++a)
    for (int b = 0; b <= a; ++b) s[a][b].setZero();
  for (std::size_t q = 0; q < element.points(); ++q) {
    const Eigen::Map<const Eigen::Matrix<double, n, d>> g(gradients + q * n * d);
    for (int a = 0; a < d; ++a) {
      const Eigen::Matrix<double, n, 1> weighted = volumes[q] * g.col(a);
      for (int b = 0; b <= a; ++b) s[a][b].noalias() += weighted.lazyProduct(g.col(b).transpose());
    }
  }
  Block trace = mu * s[0][0];
  for (int a = 1; a < d; ++a) trace += mu * s[a][a];
  const auto put = [&](int a, int b, const Block& block) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) k[(j * d + b) * n * d + i * d + a] = block(i, j);
  };
  for (int a = 0; a < d; ++a) {
    put(a, a, (lambda + mu) * s[a][a] + trace);
    for (int b = 0; b < a; ++b) {
      const Block block = lambda * s[a][b] + mu * s[a][b].transpose();
      put(a, b, block);
      put(b, a, block.transpose());
    }
  }
}

}  // namespace mortise::fem
