// Stresses on the surface of a body from its displacements and tractions.
//
// On a panel the tangential derivatives of u, which is linear there, and the traction t = sigma n give the whole gradient of u by
// Hooke's law: with P = I - n n' and the surface gradient g = (grad u) P,
//
//     d u / d n = P (t / mu - g'n) + n (t . n - lambda tr g) / (lambda + 2 mu).
//
// Plane models: plane strain, with the stress across the plane; for plane stress see plane_state.hpp.
#pragma once

#include <Eigen/Core>

#include "bem/panels.hpp"
#include "fem/options.hpp"
#include "fem/stress.hpp"

namespace mortise::bem {

/// XX YY ZZ XY YZ XZ of a symmetric tensor.
fem::Stress components(const Eigen::Matrix3d& tensor);

/// The traction sigma n.
Point traction(const fem::Stress& stress, const Point& normal);

/// Stress tensor of the gradient d u_i / d x_j.
Eigen::Matrix3d hooke(const fem::Material& material, const Eigen::Matrix3d& gradient);

/// d u_i / d x_j on a panel, inside the body, of displacements u (D n) and tractions t (D m).
template <int D>
Eigen::Matrix3d panel_gradient(const PanelsIn<D>& panels, const fem::Material& material, std::size_t panel,
                               const Eigen::VectorXd& u, const Eigen::VectorXd& t);

/// The stress on each panel, m x 6, XX YY ZZ XY YZ XZ. Of first order in the size of the panels.
template <int D>
Eigen::MatrixXd panel_stresses(const PanelsIn<D>& panels, const fem::Material& material, const Eigen::VectorXd& u,
                               const Eigen::VectorXd& t);

/// For each panel of a plane body an estimate of the squared energy norm of the error of u, that it is linear on panels:
/// mu h / (2 pi (1 - nu)) times the integral of |(G* - G) tangent|^2 over its length h, G the gradient, G* linear between the
/// means of G at nodes. To an error that repeats itself from panel to panel S gives this energy.
Eigen::VectorXd interpolation_errors(const PlanePanels& panels, const fem::Material& material, const Eigen::VectorXd& u,
                                     const Eigen::VectorXd& t);

}  // namespace mortise::bem
