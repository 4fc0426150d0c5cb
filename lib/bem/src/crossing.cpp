#include "crossing.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace mortise::bem {

namespace {

constexpr double most_amiss = 0.02;  // of a panel that lies inside: beyond what the quadrature leaves

}  // namespace

template <int D>
void require_border(const PanelsIn<D>& panels, const Eigen::MatrixXd& double_layer)
{
  const Eigen::Map<const Eigen::VectorXd> area(panels.area.data(), panels.size());
  Eigen::Index worst = 0;
  const double amiss = ((double_layer.rowwise().sum().array() / area.array()) + 0.5).abs().maxCoeff(&worst);
  if (amiss <= most_amiss) return;
  const Point x = panels.middle(static_cast<std::size_t>(worst));
  throw Error(
      ExitStatus::bad_input,
      fmt::format("the surface crosses itself or lies on itself near ({:.6g}, {:.6g}, {:.6g}), or is thinner there than a "
                  "millionth of its size",
                  x[0], x[1], x[2]));
}
template void require_border(const PanelsIn<2>&, const Eigen::MatrixXd&);
template void require_border(const PanelsIn<3>&, const Eigen::MatrixXd&);

}  // namespace mortise::bem
