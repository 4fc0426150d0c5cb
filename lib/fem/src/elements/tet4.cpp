#include "elements.hpp"

namespace mortise::fem {

Element tet4()
{
  return make_element<4, 3>({{{0.25, 0.25, 0.25}, 1.0 / 6}},
                            [](const Eigen::Vector3d& x, Eigen::VectorXd& value, Eigen::MatrixXd& gradient) {
                              value << 1 - x[0] - x[1] - x[2], x[0], x[1], x[2];
                              gradient << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
                            });
}

}  // namespace mortise::fem
