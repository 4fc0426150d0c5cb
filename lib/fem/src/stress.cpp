#include "fem/stress.hpp"

#include <cmath>

#include "fem/stiffness.hpp"
#include "geometry.hpp"

namespace mortise::fem {

namespace {

// Stress from the displacement gradient H = du_i/dx_j, d x d.
Stress stress_of(const Eigen::MatrixXd& h, const Lame& constants, Kinematics kinematics)
{
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
  strain.topLeftCorner(h.rows(), h.cols()) = 0.5 * (h + h.transpose());
  Eigen::Matrix3d s = constants.lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * constants.mu * strain;
  if (kinematics == Kinematics::plane_stress) s(2, 2) = 0;
  return (Stress() << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)).finished();
}

}  // namespace

double von_mises(const Stress& s)
{
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

StressField stresses(const mesh::Mesh& mesh, const Material& material, Kinematics kinematics, const Eigen::VectorXd& u)
{
  const int d = kinematics == Kinematics::solid ? 3 : 2;
  const Lame constants = lame(material, kinematics);
  StressField field;
  field.nodal_sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.node_count()), 7);
  field.cell_von_mises.resize(static_cast<Eigen::Index>(mesh.cells.size()));
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    const Element& cell = element(mesh.cells.type[c]);
    const Eigen::MatrixXd x = coordinates(mesh, nodes, d);
    Eigen::MatrixXd displacement(d, cell.nodes);
    for (int i = 0; i < cell.nodes; ++i) displacement.col(i) = u.segment(nodes[static_cast<std::size_t>(i)] * d, d);
    Eigen::MatrixXd at_points(static_cast<Eigen::Index>(cell.weight.size()), 6);
    Stress mean = Stress::Zero();
    double volume = 0;
    for (std::size_t q = 0; q < cell.weight.size(); ++q) {
      const auto [gradient, part] = space_gradient(cell, x, q);
      const Stress s = stress_of(displacement * gradient, constants, kinematics);
      at_points.row(static_cast<Eigen::Index>(q)) = s.transpose();
      mean += part * s;
      volume += part;
    }
    field.cell_von_mises[static_cast<Eigen::Index>(c)] = von_mises(mean / volume);
    const Eigen::MatrixXd at_nodes = cell.extrapolation * at_points;
    for (int i = 0; i < cell.nodes; ++i) {
      auto row = field.nodal_sums.row(nodes[static_cast<std::size_t>(i)]);
      row.head(6) += volume * at_nodes.row(i);
      row[6] += volume;
    }
  }
  return field;
}

}  // namespace mortise::fem
