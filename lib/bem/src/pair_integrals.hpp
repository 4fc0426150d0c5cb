// Double integrals over two panels X and Y, of the kernels of which those of elasticity are made:
//
//     single = II 1/r,   tensor = II d d'/r^3,   double_y[k] = II n_y.d/r^3 phi_k(y),   double_x[k] = -II n_x.d/r^3 phi_k(x),
//
// d = x - y, r = |d|, all divided by 4 pi; phi_k is linear and 1 in corner k. tensor: XX YY ZZ XY YZ XZ.
#pragma once

#include <array>
#include <span>

#include "bem/panels.hpp"
#include "rules.hpp"

namespace mortise::bem {

struct PairIntegrals {
  double single = 0;
  std::array<double, 6> tensor{};
  std::array<double, 3> double_x{}, double_y{};

  PairIntegrals times(double factor) const;
};

/// Makes all integrals of a surface to about `accuracy`, relative to those of a panel with its neighbours.
class PairQuadrature {
 public:
  PairQuadrature(const Panels& panels, double accuracy);

  /// Integrals of panel x with each of `others`, results in the same order. Pairs with common corners are integrated in
  /// coordinates in which the kernels are smooth [Sauter and Schwab, Boundary Element Methods, Springer 2011, section 5.2],
  /// others by rules that fit their distance. Panels that are too close for a rule, or too slender for those coordinates: the
  /// potentials of the larger one in closed form, and the smaller one in parts, graded towards the edges of the other.
  void integrate(std::size_t x, std::span<const std::size_t> others, std::span<PairIntegrals> results) const;

  /// Points at which kernels or potentials were evaluated for close pairs so far.
  std::size_t evaluations() const { return evaluations_; }

 private:
  struct Far;
  struct Touching;
  struct Graded;
  PairIntegrals close(std::size_t x, std::size_t y) const;
  PairIntegrals graded(std::size_t x, std::size_t y) const;
  PairIntegrals touching(std::size_t x, std::size_t y, const std::array<int, 3>& of_x, const std::array<int, 3>& of_y,
                         int common) const;

  const Panels& panels_;
  double accuracy_;
  std::array<double, triangle_rules> largest_;   // sizes over distance, up to which each rule will do
  std::array<double, triangle_rules> steepest_;  // variation over a part, up to which each rule will do
  mutable std::size_t evaluations_ = 0;
  std::vector<Point> centre_;
  std::vector<double> radius_;
  // Points of each rule on each panel: points_[rule][(point * 3 + component) * panels + panel].
  std::vector<std::vector<double>> points_;
};

}  // namespace mortise::bem
