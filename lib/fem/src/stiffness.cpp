#include "fem/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.hpp"
#include "formulation.hpp"

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
  // The cells of each node.
  const auto nodes = mesh.node_count();
  std::vector<int> first(nodes + 1, 0), cells(mesh.cells.nodes.size());
  for (const Local n : mesh.cells.nodes) ++first[static_cast<std::size_t>(n) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const Local n : mesh.cells[c])
      cells[static_cast<std::size_t>(next[static_cast<std::size_t>(n)]++)] = static_cast<int>(c);

  Adjacency result;
  std::vector<Local> seen_from(nodes, -1);
  for (std::size_t a = 0; a < nodes; ++a) {
    result.nodes.push_back(static_cast<Local>(a));  // also if no cell has the node
    seen_from[a] = static_cast<Local>(a);
    for (int i = first[a]; i < first[a + 1]; ++i)
      for (const Local b : mesh.cells[static_cast<std::size_t>(cells[static_cast<std::size_t>(i)])]) {
        auto& seen = seen_from[static_cast<std::size_t>(b)];
        if (b < static_cast<Local>(a) || seen == static_cast<Local>(a)) continue;
        seen = static_cast<Local>(a);
        result.nodes.push_back(b);
      }
    std::sort(result.nodes.begin() + result.offset.back(), result.nodes.end());
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
        for (int a = graph.nodes[static_cast<std::size_t>(n)] == j ? b : 0; a < d; ++a)
          inner[at++] = graph.nodes[static_cast<std::size_t>(n)] * d + a;
    }
  std::fill_n(k.valuePtr(), outer[nodes * d], 0.0);
  return k;
}

void require_positive(const CellGeometry& cell)
{
  for (const double volume : cell.volumes()) {
    if (volume > 0) continue;
    const auto& x = cell.coordinates();
    const auto n = static_cast<std::size_t>(cell.element().nodes);
    throw Error(ExitStatus::bad_input,
                fmt::format("a cell near ({:.4g}, {:.4g}, {:.4g}) is turned inside out or too distorted (its Jacobian "
                            "is not positive); improve the mesh there, or give its nodes the order of the file's format",
                            x[0], x[n], x.size() > 2 * n ? x[2 * n] : 0.0));
  }
}

// Whether the nodes at x are those at `other` moved as a whole, as far as the rounding of the coordinates lets one tell.
// In axisymmetry they must be as far from the axis.
bool is_translate(const std::vector<double>& x, const std::vector<double>& other, Kinematics kinematics)
{
  const auto n = x.size() / static_cast<std::size_t>(dimension(kinematics));
  double size = 0, difference = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto first = i - i % n;
    size = std::max({size, std::abs(x[i]), std::abs(other[i])});
    const double moved = kinematics == Kinematics::axisymmetric && first == 0 ? 0 : x[first] - other[first];
    difference = std::max(difference, std::abs(x[i] - other[i] - moved));
  }
  return difference <= 4 * std::numeric_limits<double>::epsilon() * size;
}

// Adds the (d n) x (d n) matrix of a cell to the lower triangle.
void scatter(const std::vector<double>& local, std::span<const Local> nodes, const Adjacency& graph, int d, Sparse& k)
{
  const int* outer = k.outerIndexPtr();
  double* values = k.valuePtr();
  const auto stride = static_cast<int>(nodes.size()) * d;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Local column = nodes[j];
    const auto begin = graph.nodes.begin() + graph.offset[column], end = graph.nodes.begin() + graph.offset[column + 1];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Local row = nodes[i];
      if (row < column) continue;
      const int place = static_cast<int>(std::lower_bound(begin, end, row) - begin);
      for (int b = 0; b < d; ++b) {
        const double* from = local.data() + (static_cast<int>(j) * d + b) * stride + static_cast<int>(i) * d;
        double* to = values + outer[column * d + b] + place * d - b;
        for (int a = row == column ? b : 0; a < d; ++a) to[a] += from[a];
      }
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

Sparse stiffness(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, Formulation formulation)
{
  const int d = dimension(kinematics);
  std::vector<CellFormulation> cell_formulation;
  std::vector<Elasticity> elasticity;
  for (std::size_t m = 0; m < materials.count(); ++m)
    elasticity.emplace_back(materials[m], kinematics), cell_formulation.emplace_back(formulation, elasticity[m], kinematics);
  const Adjacency graph = adjacency(mesh);
  Sparse k = pattern(graph, d);
  // Cells that are translates of the one before, as in every structured mesh, share its matrix if their material is the same.
  CellGeometry cell(kinematics);
  std::vector<double> local, computed_for;
  const Element* computed_with = nullptr;
  std::size_t computed_of = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    cell.gather(mesh, c);
    const std::size_t place = materials.index(c);
    if (computed_with != &cell.element() || computed_of != place || !elasticity[place].uniform() ||
        !is_translate(cell.coordinates(), computed_for, kinematics)) {
      cell.evaluate();
      require_positive(cell);
      computed_with = &cell.element();
      computed_for = cell.coordinates();
      computed_of = place;
      cell_formulation[place].stiffness(cell, local);
    }
    scatter(local, mesh.cells[c], graph, d, k);
  }
  return k;
}

int rigid_motion_count(Kinematics kinematics)
{
  return kinematics == Kinematics::solid ? 6 : kinematics == Kinematics::axisymmetric ? 1 : 3;
}

Eigen::MatrixXd rigid_motions(std::span<const Point> points, Kinematics kinematics)
{
  const int d = dimension(kinematics), modes = rigid_motion_count(kinematics);
  const auto n = static_cast<Eigen::Index>(points.size());
  Point centre = Point::Zero();
  for (const auto& p : points) centre += p;
  centre /= static_cast<double>(std::max<Eigen::Index>(n, 1));
  double radius = 0;
  for (const auto& p : points) radius += (p - centre).squaredNorm();
  radius = std::sqrt(radius / static_cast<double>(std::max<Eigen::Index>(n, 1)));
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(n * d, modes);
  if (kinematics == Kinematics::axisymmetric) {
    for (Eigen::Index i = 0; i < n; ++i) r(2 * i + 1, 0) = 1 / std::sqrt(static_cast<double>(n));
    return r;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Point x = (points[static_cast<std::size_t>(i)] - centre) / radius;
    r.block(i * d, 0, d, d).setIdentity();
    if (d == 3)
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
