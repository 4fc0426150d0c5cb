// What is done for every cell of a mesh, compiled for fixed sizes so that nothing is allocated and the compiler can vectorise.
#pragma once

#include <Eigen/Dense>

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
// node. Plain loops: Eigen would unroll all of them, which gains little and takes a compiler with sanitizers minutes.
template <int n, int d>
void stiffness_of_cell(const Element& element, const double* gradients, const double* volumes, double lambda, double mu,
                       double* k)
{
  double s[d][d][n][n];
  for (int a = 0; a < d; ++a)
    for (int b = 0; b <= a; ++b)
      for (int j = 0; j < n; ++j) {
        double sum[n] = {};
        for (std::size_t q = 0; q < element.points(); ++q) {
          const double* g = gradients + q * n * d;
          const double factor = volumes[q] * g[b * n + j];
          for (int i = 0; i < n; ++i) sum[i] += factor * g[a * n + i];
        }
        for (int i = 0; i < n; ++i) s[a][b][j][i] = s[b][a][i][j] = sum[i];
      }
  double trace[n][n] = {};
  for (int a = 0; a < d; ++a)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) trace[j][i] += mu * s[a][a][j][i];
  for (int j = 0; j < n; ++j)
    for (int b = 0; b < d; ++b) {
      double* column = k + (j * d + b) * n * d;
      for (int i = 0; i < n; ++i)
        for (int a = 0; a < d; ++a)
          column[i * d + a] = lambda * s[a][b][j][i] + mu * s[b][a][j][i] + (a == b ? trace[j][i] : 0.0);
    }
}

}  // namespace mortise::fem
