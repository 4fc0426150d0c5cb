#include <cmath>

#include "elements.hpp"

namespace mortise::fem {

// Linear on the triangle times linear in z in [-1, 1]; three points of degree 2 times two of Gauss.
Element prism6()
{
  const double g = 1 / std::sqrt(3.0), a = 1.0 / 6, b = 2.0 / 3;
  std::vector<IntegrationPoint> points;
  for (const double z : {-g, g})
    for (const auto& [x, y] : {std::pair(a, a), std::pair(b, a), std::pair(a, b)}) points.push_back({{x, y, z}, 1.0 / 6});
  return make_element<6, 3>(points, [](const Eigen::Vector3d& x, Eigen::VectorXd& value, Eigen::MatrixXd& gradient) {
    const double l[3] = {1 - x[0] - x[1], x[0], x[1]};
    const double dl[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
    for (int layer = 0; layer < 2; ++layer) {
      const double sign = layer == 0 ? -1 : 1, h = 0.5 * (1 + sign * x[2]);
      for (int i = 0; i < 3; ++i) {
        value[3 * layer + i] = l[i] * h;
        gradient.row(3 * layer + i) << dl[i][0] * h, dl[i][1] * h, 0.5 * sign * l[i];
      }
    }
  });
}

}  // namespace mortise::fem
