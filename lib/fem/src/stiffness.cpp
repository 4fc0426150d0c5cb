#include "fem/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "geometry.hpp"

namespace mortise::fem {

namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

// For each node the nodes >= it that share a cell with it, ascending, itself included.
struct Adjacency {
  std::vector<int> offset{0};
  std::vector<Local> nodes;
};

Adjacency adjacency(const mesh::Mesh& mesh)
{
  std::vector<std::vector<Local>> lists(mesh.node_count());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const Local a : mesh.cells[c])
      for (const Local b : mesh.cells[c])
        if (b >= a) lists[static_cast<std::size_t>(a)].push_back(b);
  Adjacency result;
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    result.nodes.insert(result.nodes.end(), list.begin(), list.end());
    result.offset.push_back(static_cast<int>(result.nodes.size()));
  }
  return result;
}

// A lower triangle with a full d x d block for each pair of neighbours, all zero.
Sparse pattern(const Adjacency& graph, int d)
{
  const auto nodes = static_cast<int>(graph.offset.size()) - 1;
  Sparse k(nodes * d, nodes * d);
  std::vector<int> length(static_cast<std::size_t>(nodes * d));
  for (int j = 0; j < nodes; ++j)
    for (int b = 0; b < d; ++b) length[static_cast<std::size_t>(j * d + b)] = (graph.offset[j + 1] - graph.offset[j]) * d - b;
  k.resizeNonZeros(0);
  int* outer = k.outerIndexPtr();
  outer[0] = 0;
  for (int c = 0; c < nodes * d; ++c) outer[c + 1] = outer[c] + length[static_cast<std::size_t>(c)];
  k.resizeNonZeros(outer[nodes * d]);
  int* inner = k.innerIndexPtr();
  for (int j = 0; j < nodes; ++j)
    for (int b = 0; b < d; ++b) {
      int at = outer[j * d + b];
      for (int n = graph.offset[j]; n < graph.offset[j + 1]; ++n)
        for (int a = graph.nodes[static_cast<std::size_t>(n)] == j ? b : 0; a < d; ++a) inner[at++] = graph.nodes[static_cast<std::size_t>(n)] * d + a;
    }
  std::fill_n(k.valuePtr(), outer[nodes * d], 0.0);
  return k;
}

// Element stiffness from S = sum over q of w g g', g the stacked gradients: block ij is lambda S_ij + mu S_ij' + mu tr(S_ij) I.
Eigen::MatrixXd element_stiffness(const Element& element, const Eigen::MatrixXd& x, const Lame& lame, Global cell_id)
{
  const int n = element.nodes, d = element.dimension;
  Eigen::MatrixXd gradients(n * d, static_cast<Eigen::Index>(element.weight.size())), weighted = gradients;
  for (std::size_t q = 0; q < element.weight.size(); ++q) {
    const auto [gradient, volume] = space_gradient(element, x, q);
    if (!(volume > 0))
      throw Error(ExitStatus::bad_input, fmt::format("cell {} near ({:.4g}, {:.4g}, {:.4g}) is turned inside out or too distorted (its Jacobian is not positive); improve the mesh there",
                                                     cell_id, x(0, 0), x(0, 1), d == 3 ? x(0, 2) : 0.0));
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < d; ++c) gradients(i * d + c, static_cast<Eigen::Index>(q)) = gradient(i, c);
    weighted.col(static_cast<Eigen::Index>(q)) = volume * gradients.col(static_cast<Eigen::Index>(q));
  }
  const Eigen::MatrixXd s = weighted * gradients.transpose();
  Eigen::MatrixXd k(n * d, n * d);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto block = s.block(i * d, j * d, d, d);
      k.block(i * d, j * d, d, d) = lame.lambda * block + lame.mu * block.transpose() + lame.mu * block.trace() * Eigen::MatrixXd::Identity(d, d);
    }
  return k;
}

void add(const Eigen::MatrixXd& local, std::span<const Local> nodes, const Adjacency& graph, int d, Sparse& k)
{
  const int* outer = k.outerIndexPtr();
  double* values = k.valuePtr();
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Local column = nodes[j];
    const auto begin = graph.nodes.begin() + graph.offset[column], end = graph.nodes.begin() + graph.offset[column + 1];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Local row = nodes[i];
      if (row < column) continue;
      const int place = static_cast<int>(std::lower_bound(begin, end, row) - begin);
      for (int b = 0; b < d; ++b)
        for (int a = row == column ? b : 0; a < d; ++a)
          values[outer[column * d + b] + place * d + a - b] += local(static_cast<Eigen::Index>(i) * d + a, static_cast<Eigen::Index>(j) * d + b);
    }
  }
}

}  // namespace

Lame lame(const Material& material, Kinematics kinematics)
{
  const double e = material.young_modulus, nu = material.poisson_ratio;
  const double mu = e / (2 * (1 + nu)), lambda = e * nu / ((1 + nu) * (1 - 2 * nu));
  if (kinematics == Kinematics::plane_stress) return {2 * lambda * mu / (lambda + 2 * mu), mu};
  return {lambda, mu};
}

Sparse stiffness(const mesh::Mesh& mesh, const Material& material, Kinematics kinematics)
{
  const int d = kinematics == Kinematics::solid ? 3 : 2;
  const Lame constants = lame(material, kinematics);
  const Adjacency graph = adjacency(mesh);
  Sparse k = pattern(graph, d);
  // Cells that are translates of the one before, as in every structured mesh, share its matrix.
  Eigen::MatrixXd local, shape;
  mesh::CellType type{};
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Eigen::MatrixXd x = coordinates(mesh, mesh.cells[c], d);
    const Eigen::MatrixXd relative = x.rowwise() - x.row(0);
    const bool same = c > 0 && mesh.cells.type[c] == type && (relative - shape).cwiseAbs().maxCoeff() <= 1e-13 * relative.cwiseAbs().maxCoeff();
    if (!same) {
      type = mesh.cells.type[c];
      shape = relative;
      local = element_stiffness(element(type), x, constants, mesh.cell_id[c]);
    }
    add(local, mesh.cells[c], graph, d, k);
  }
  return k;
}

Eigen::MatrixXd rigid_motions(std::span<const Point> points, int dimension)
{
  const auto n = static_cast<Eigen::Index>(points.size());
  Point centre = Point::Zero();
  for (const auto& p : points) centre += p;
  centre /= static_cast<double>(std::max<Eigen::Index>(n, 1));
  double radius = 0;
  for (const auto& p : points) radius += (p - centre).squaredNorm();
  radius = std::sqrt(radius / static_cast<double>(std::max<Eigen::Index>(n, 1)));
  const int modes = dimension == 3 ? 6 : 3;
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(n * dimension, modes);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Point x = (points[static_cast<std::size_t>(i)] - centre) / radius;
    r.block(i * dimension, 0, dimension, dimension).setIdentity();
    if (dimension == 3)
      for (int axis = 0; axis < 3; ++axis) r.block(i * 3, 3 + axis, 3, 1) = Point::Unit(axis).cross(x);
    else
      r.block(i * 2, 2, 2, 1) = Eigen::Vector2d(-x[1], x[0]);
  }
  // Two passes of Gram-Schmidt: translations stay translations.
  for (int pass = 0; pass < 2; ++pass)
    for (int k = 0; k < modes; ++k) {
      for (int j = 0; j < k; ++j) r.col(k) -= r.col(j).dot(r.col(k)) * r.col(j);
      r.col(k).normalize();
    }
  return r;
}

}  // namespace mortise::fem
