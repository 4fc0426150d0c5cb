#include "elements.hpp"

namespace mortise::fem {

// Linear: one point integrates the stiffness and constant loads exactly.
Element tri3()
{
  return make_element<3, 2>({{{1.0 / 3, 1.0 / 3, 0}, 0.5}},
                            [](const Eigen::Vector3d& x, Eigen::VectorXd& value, Eigen::MatrixXd& gradient) {
                              value << 1 - x[0] - x[1], x[0], x[1];
                              gradient << -1, -1, 1, 0, 0, 1;
                            });
}

}  // namespace mortise::fem
