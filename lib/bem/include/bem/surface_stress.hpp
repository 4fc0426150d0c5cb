// The stress at the surface, from displacements and tractions there.
#pragma once

#include <Eigen/Core>

#include "bem/panels.hpp"
#include "fem/options.hpp"
#include "fem/stress.hpp"

namespace mortise::bem {

/// sigma n.
Point traction(const fem::Stress& stress, const Point& normal);

/// Stress of each panel, m x 6 (XX YY ZZ XY YZ XZ), of displacements u, 3 n, and tractions t, 3 m: the gradient of u along the
/// panel, and across it the derivative a with sigma n = t,
///     (lambda + 2 mu) a.n = t.n - lambda div_s u,   a - (a.n) n = (t - (t.n) n) / mu - (grad_s u)' n.
Eigen::MatrixXd panel_stresses(const Panels& panels, const fem::Material& material, const Eigen::VectorXd& u,
                               const Eigen::VectorXd& t);

}  // namespace mortise::bem
