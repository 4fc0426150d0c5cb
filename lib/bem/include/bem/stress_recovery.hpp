// Stresses of second order at the nodes of a surface and near it, from the displacements and tractions of the panels around.
//
// Round each node the displacement is a polynomial of degree 2 in space,
//
//     v(x) = sum_a c_a p_a((x - x_node) / h),   10 monomials, 30 coefficients (in a plane 6 and 12),
//
// that fits the nodal values u / h and, in the middle of each panel, the traction t / E in least squares, with div sigma(v) = 0
// [in the manner of Zhang and Naga, SIAM J. Sci. Comput. 26 (2005), for gradients of finite elements]. Stresses that are linear
// in space are exact, on a face as at an edge or a corner: the fit spans the faces, as its stress is that of the inside, which
// has no jump there. Plane models: plane strain.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bem/panels.hpp"
#include "fem/options.hpp"
#include "fem/stress.hpp"

namespace mortise::bem {

/// The stress round one node, sigma(x) = constant + slope (x - node), XX YY ZZ XY YZ XZ.
struct LinearStress {
  fem::Stress constant;
  Eigen::Matrix<double, 6, 3> slope;
};

template <int D>
class StressRecovery {
 public:
  /// Keeps a reference to `panels`.
  StressRecovery(const PanelsIn<D>& panels, const fem::Material& material);

  /// The stress round a node, of displacements u (D n) and tractions t (D m).
  LinearStress at(Local node, const Eigen::VectorXd& u, const Eigen::VectorXd& t) const;

 private:
  struct Patch {
    std::vector<Local> nodes;
    std::vector<std::size_t> panels;
  };
  Patch patch(Local node) const;

  const PanelsIn<D>& panels_;
  fem::Material material_;
  std::vector<std::vector<std::size_t>> around_;  // panels of each node
};

/// n x 7: in each node its part, 1 / D, of the area of its panels times its stress, and that area. Added up over the copies of a
/// node and divided by the last column this is the recovered stress (see fem::StressField::nodal_sums).
template <int D>
Eigen::MatrixXd nodal_sums(const PanelsIn<D>& panels, const fem::Material& material, const Eigen::VectorXd& u,
                           const Eigen::VectorXd& t);

}  // namespace mortise::bem
