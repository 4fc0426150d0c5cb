// Meshes and fields that the tests of fem share.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fem/stiffness.hpp"
#include "mesh/blocks.hpp"

namespace mortise::fem::test {

/// A structured block [0, size] of one kind of cell; 2D if `element` is.
struct Block {
  std::string element;
  std::array<int, 3> cells{3, 3, 3};
  std::array<double, 3> size{1, 1, 1};
  mesh::Mesh mesh;
  std::vector<std::string> boundaries;
  int dimension;

  Block(const std::string& element_name, std::array<int, 3> cell_counts, std::array<double, 3> lengths = {1, 1, 1})
      : element(element_name),
        cells(cell_counts),
        size(lengths),
        dimension(mesh::dimension(mesh::cell_type(element_name).value()))
  {
    if (dimension == 2) cells[2] = 0, size[2] = 0;
    mesh::Options options;
    options.blocks["block"] = {{0, 0, 0}, size, cells, element};
    auto last = cells;
    if (dimension == 2) last[2] = 1;
    mesh = mesh::generate(options, dimension, 0, {0, 0, 0}, last);
    boundaries = mesh::block_catalogue(options, dimension).boundaries;
  }

  /// Index of the boundary "xmin", ...
  int boundary(const std::string& side) const
  {
    return static_cast<int>(std::find(boundaries.begin(), boundaries.end(), "block." + side) - boundaries.begin());
  }
  bool on_surface(std::size_t node) const
  {
    for (int c = 0; c < dimension; ++c)
      if (std::abs(mesh.points[node][c]) < 1e-9 || std::abs(mesh.points[node][c] - size[static_cast<std::size_t>(c)]) < 1e-9)
        return true;
    return false;
  }
  /// Moves the nodes inside (or all) by up to `amount` (a third of it in cells of second order), irregularly but always alike.
  Block& distort(double amount, bool all = false)
  {
    const auto type = mesh.cells.type[0];
    if (type != mesh::first_order(type)) amount /= 3;
    std::vector<bool> fixed;
    for (std::size_t n = 0; n < mesh.node_count(); ++n) fixed.push_back(!all && on_surface(n));
    for (std::size_t n = 0; n < mesh.node_count(); ++n)
      for (int c = 0; c < dimension && !fixed[n]; ++c)
        mesh.points[n][c] += amount * std::sin(1.7 * static_cast<double>(n) + 2.3 * c);
    return *this;
  }
  double measure() const { return size[0] * size[1] * (dimension == 3 ? size[2] : 1.0); }
};

/// Nodal values of u(x).
template <class Field>
Eigen::VectorXd sample(const mesh::Mesh& mesh, int dimension, const Field& field)
{
  Eigen::VectorXd u(static_cast<Eigen::Index>(mesh.node_count()) * dimension);
  for (std::size_t n = 0; n < mesh.node_count(); ++n)
    u.segment(static_cast<Eigen::Index>(n) * dimension, dimension) = Point(field(mesh.points[n])).head(dimension);
  return u;
}

/// A displacement gradient with all its components different.
inline Eigen::Matrix3d some_gradient(int dimension)
{
  Eigen::Matrix3d a;
  a << 1.0, -0.7, 0.4, 0.2, -0.5, 0.9, -0.3, 0.6, 1.3;
  if (dimension == 2) a.row(2).setZero(), a.col(2).setZero();
  return 1e-3 * a;
}

/// Hooke's law for a displacement gradient, written with Young's modulus and Poisson's ratio: strain from stress, inverted
/// numerically.
inline Eigen::Matrix3d hooke(const Eigen::Matrix3d& gradient, const Material& m, Kinematics kinematics)
{
  Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const double e = m.young_modulus, nu = m.poisson_ratio;
  // In plane stress the thickness changes so that no stress acts across the plane.
  if (kinematics == Kinematics::plane_stress) strain(2, 2) = -nu / (1 - nu) * (strain(0, 0) + strain(1, 1));
  Eigen::Matrix3d compliance = Eigen::Matrix3d::Constant(-nu / e);
  compliance.diagonal().setConstant(1 / e);
  const Eigen::Vector3d normal = compliance.inverse() * strain.diagonal();
  Eigen::Matrix3d stress = e / (1 + nu) * strain;
  stress.diagonal() = normal;
  return stress;
}

struct Case {
  std::string element;
  Kinematics kinematics;
};
inline std::vector<Case> all_cases()
{
  using enum Kinematics;
  return {{"tet4", solid},        {"hex8", solid},         {"prism6", solid},       {"tri3", plane_strain},
          {"tri3", plane_stress}, {"quad4", plane_strain}, {"quad4", plane_stress}, {"tet10", solid},
          {"hex20", solid},       {"hex27", solid},        {"prism15", solid},      {"prism18", solid},
          {"tri6", plane_strain}, {"quad8", plane_stress}, {"quad9", plane_strain}};
}

inline Material steel()
{
  return {2.1e5, 0.3, 7.85e-9, 0};
}

inline Eigen::MatrixXd dense(const Eigen::SparseMatrix<double, Eigen::ColMajor, int>& lower)
{
  return Eigen::MatrixXd(Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>());
}

}  // namespace mortise::fem::test
