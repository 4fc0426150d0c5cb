// Stresses of second order at the nodes of a surface and near it, from the displacements, tractions and forces around.
//
// Round each node the displacement is a polynomial of degree 2 in space,
//
//     v(x) = sum_a c_a p_a((x - x_node) / h),   10 monomials, 30 coefficients (in a plane 6 and 12),
//
// that fits in least squares, with div sigma(v) = 0, the nodal values u / h, in the middle of each panel the traction t / E, and
// the force on the node, f = integral of sigma(v) n phi [in the manner of Zhang and Naga, SIAM J. Sci. Comput. 26 (2005), for
// gradients of finite elements]. Galerkin's method gives u and f well, but t, one order less smooth, poorly on small panels and
// where a body is cut: edges of pieces are sharp. So tractions count less, by the root of the panel's area as well. The panels at
// the node hardly tell second derivatives: these are drawn to those of a fit to two rings of panels.
//
// Stresses that are linear in space are exact, on a face as at an edge or a corner: the fit spans the faces, as its stress is
// that of the inside, which has no jump there. Plane models: plane strain.
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

/// What a constant and a linear stress do at the nodes: rows integral of phi n (D) and of phi n (x - node)' (D x D, by columns),
/// n in all. Added up over the copies of a node they are those of the whole body's surface: cuts have both normals.
template <int D>
Eigen::MatrixXd nodal_normals(const PanelsIn<D>& panels);

/// Displacements u (D n) and tractions t (D m) of a surface, and forces on its nodes from outside (n x D) with nodal_normals(),
/// both of the whole body; without forces none are fitted.
struct SurfaceValues {
  const Eigen::VectorXd &u, &t;
  Eigen::MatrixXd forces = {}, normals = {};
};

template <int D>
class StressRecovery {
 public:
  /// Keeps a reference to `panels`.
  StressRecovery(const PanelsIn<D>& panels, const fem::Material& material);

  /// The stress round a node.
  LinearStress at(Local node, const SurfaceValues& values) const;

 private:
  struct Patch {
    std::vector<Local> nodes;
    std::vector<std::size_t> panels;
  };
  struct Fit {
    Eigen::VectorXd coefficients;
    double h;
  };
  Patch patch(Local node, int rings) const;
  Fit fit(Local node, const SurfaceValues& values, const Patch& patch, const Fit* wider) const;

  const PanelsIn<D>& panels_;
  fem::Material material_;
  std::vector<std::vector<std::size_t>> around_;  // panels of each node
};

/// Of each node the stress round it, forces per area: n of them. `values`: at the same nodes and panels.
template <int D>
std::vector<LinearStress> recovered_stresses(const PanelsIn<D>& panels, const fem::Material& material,
                                             const SurfaceValues& values);

/// Each node's part, 1 / D, of the area (of lines the length) of its panels: n of them.
template <int D>
Eigen::VectorXd nodal_areas(const PanelsIn<D>& panels);

}  // namespace mortise::bem
