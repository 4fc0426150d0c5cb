// The feasible set Omega of the quadratic programme: a product of half-lines x_i >= l_i, of intervals |x_i| <= r, of discs
// ||(x_i, x_j)|| <= r, and of the whole line for every other unknown. Each factor lives on one rank, so nothing here
// communicates.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "base/types.hpp"

namespace mortise::qp {

/// x_index >= lower.
struct Bound {
  Local index;
  double lower = 0;
};

/// ||x - centre|| <= radius over one (an interval) or two unknowns. An infinite radius constrains nothing; radius 0 pins the
/// unknowns at the centre.
struct Disc {
  std::array<Local, 2> index{-1, -1};  ///< the second is -1 for an interval
  double radius = std::numeric_limits<double>::infinity();
  std::array<double, 2> centre{0, 0};
  Local normal = -1;       ///< Coulomb friction: the unknown that the radius follows,
  double coefficient = 0;  ///< radius = coefficient * x[normal], from one set of radii to the next

  /// Unknowns: 1 or 2.
  int size() const { return index[1] < 0 ? 1 : 2; }
};

/// Omega over the unknowns of this rank. A value.
class FeasibleSet {
 public:
  FeasibleSet() = default;
  FeasibleSet(std::vector<Bound> bounds, std::vector<Disc> discs) : bounds_(std::move(bounds)), discs_(std::move(discs)) {}

  /// In the order of the constructor; an unknown is in at most one bound or disc.
  std::span<const Bound> bounds() const { return bounds_; }
  std::span<const Disc> discs() const { return discs_; }
  bool empty() const { return bounds_.empty() && discs_.empty(); }

  /// Of the discs, one for each.
  std::vector<double> radii() const;
  void set_radii(std::span<const double> radii);
  /// The same set with other radii.
  FeasibleSet with_radii(std::span<const double> radii) const;
  /// The coefficients of Coulomb friction, one for each disc; 0 where the radius is given.
  void set_coefficients(std::span<const double> coefficients);

  /// The set of Coulomb's law itself, in which discs with a coefficient are cones ||x_t|| <= coefficient x[normal]: larger than
  /// with any radii that an x of it gives, and convex, so that where it does not meet {G x = e} nothing obeys the law. It can be
  /// projected on; split() and feasible_step() are not for it.
  FeasibleSet with_cones() const;
  bool has_cones() const { return cones_; }
  /// Of a disc of a set with cones: whether it is one.
  bool is_cone(const Disc& disc) const { return cones_ && disc.coefficient > 0 && disc.normal >= 0; }

  /// Omega - shift: the set of all x - shift.
  FeasibleSet shifted(const Eigen::Ref<const Eigen::VectorXd>& shift) const;

  /// The unknowns with a constraint: those of the bounds, then those of the discs.
  std::vector<Local> constrained() const;
  /// The same set over the constrained unknowns alone, numbered in the order of constrained().
  FeasibleSet compact() const;

  /// x becomes the point of Omega that is nearest to it.
  void project(Eigen::Ref<Eigen::VectorXd> x) const;

  /// Splits the gradient at x in Omega [Dostal et al., DD20; MPGP]. `free` is g where no constraint is active; `chopped` is, on
  /// the active bounds and discs, what of g still leads into Omega: min(g_i, 0), and g - min(n.g, 0) n with the outward normal n.
  void split(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& g,
             Eigen::Ref<Eigen::VectorXd> free, Eigen::Ref<Eigen::VectorXd> chopped) const;

  /// The largest a such that x - a p stays in Omega, for x in Omega; infinite if the ray never leaves it.
  double feasible_step(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& p) const;

  /// How many factors are active at x: bounds, and discs of positive radius.
  struct Active {
    long long bounds = 0, discs = 0;
  };
  /// Of this rank, at x in Omega.
  Active active(const Eigen::Ref<const Eigen::VectorXd>& x) const;

 private:
  std::vector<Bound> bounds_;
  std::vector<Disc> discs_;
  bool cones_ = false;
};

/// x minus the centre of the disc, over its unknowns; the second entry of an interval is 0.
Eigen::Vector2d from_centre(const Disc& disc, const Eigen::Ref<const Eigen::VectorXd>& x);

}  // namespace mortise::qp
