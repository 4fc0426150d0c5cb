// The recovered stress next to a surface, between the nodes of a panel.
#pragma once

#include <optional>
#include <vector>

#include "bem/stress_recovery.hpp"

namespace mortise::bem {

/// Its share in a point whose distance from the nearest panel is s < 1 times the panel's size: 1 on it, falling smoothly to 0.
inline double share_of_recovered(double s)
{
  return 1 - s * s * (3 - 2 * s);
}

template <int D>
class RecoveredStress {
 public:
  /// Keeps references. Fits each node when it is first asked for.
  RecoveredStress(const PanelsIn<D>& panels, const StressRecovery<D>& recovery, const Eigen::VectorXd& u,
                  const Eigen::VectorXd& t)
      : panels_(panels), recovery_(recovery), u_(u), t_(t), fits_(panels.points.size())
  {
  }

  /// In x; `weights` of the panel's corners in the point of it that is nearest to x.
  fem::Stress at(const Point& x, std::size_t panel, const std::array<double, D>& weights)
  {
    fem::Stress stress = fem::Stress::Zero();
    for (std::size_t k = 0; k < D; ++k) {
      const Local node = panels_.corners[panel][k];
      auto& fit = fits_[static_cast<std::size_t>(node)];
      if (!fit) fit = recovery_.at(node, u_, t_);
      stress += weights[k] * (fit->constant + fit->slope * (x - panels_.corner(panel, static_cast<int>(k))));
    }
    return stress;
  }

 private:
  const PanelsIn<D>& panels_;
  const StressRecovery<D>& recovery_;
  const Eigen::VectorXd &u_, &t_;
  std::vector<std::optional<LinearStress>> fits_;
};

}  // namespace mortise::bem
