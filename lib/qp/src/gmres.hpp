// Generalised minimal residuals [Saad and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986)], without restarts.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>

namespace mortise::qp {

/// A z = b in the ordinary norm, until the residual is below `goal` or after `most` steps; adds to z. `apply(v)` takes v to A v. It
/// may replace v by P v first, a preconditioner from the right: residuals stay true ones, and z is made of what A was applied to.
/// From `look` steps on it gives up where at that pace it would take more than twice `most`. Returns the residual that is left,
/// infinite and with z as it was if numbers are none. Throws Error(interrupted) if the process is told to end.
double gmres(const std::function<Eigen::VectorXd(Eigen::VectorXd& v)>& apply, const Eigen::VectorXd& b, double goal, int most,
             Eigen::VectorXd& z, int look = std::numeric_limits<int>::max());

}  // namespace mortise::qp
