// What is left of a quadratic programme over its constrained unknowns, and one Newton step on it. See condensed_newton.hpp.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "central_path.hpp"
#include "contact_system.hpp"
#include "qp/condensed_newton.hpp"

namespace mortise::qp {

/// What each constraint is taken for in one linear problem.
struct ConstraintStates {
  enum class Kind : char { sticks, slips, gone };  // gone: the bound that the radius follows is open
  struct Slip {
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    double radius = 0, curvature = 0;  // see active_set.hpp
  };
  std::vector<char> closed;  // of each bound: the unknown is free
  std::vector<Kind> kind;    // of each disc
  std::vector<Slip> slip;
};

/// W x + H'nu - b = s, H x - C nu = e, with x in a set and s in its normal cone. W may be softened by a compliance of every
/// unknown of its own, `softness` times what the unknown has if all others are fixed.
class CondensedProgramme {
 public:
  /// `set` over the unknowns of `matrices`, which outlive it, as `factor_of_w` does.
  CondensedProgramme(const CondensedMatrices& matrices, const Eigen::LLT<Eigen::MatrixXd>& factor_of_w, FeasibleSet set,
                     Eigen::VectorXd b, Eigen::VectorXd e);
  /// The same of any system.
  CondensedProgramme(std::unique_ptr<ContactSystem> system, FeasibleSet set, Eigen::VectorXd b, Eigen::VectorXd e);

  /// Steps of unknowns become the inverse of their compliance, so softened, too, times `scale`.
  void soften(double softness, double scale = 1);
  double softness() const { return softness_; }
  /// b and e.
  struct Loads {
    Eigen::VectorXd b, e;
  };
  const Loads& loads() const { return loads_; }
  /// Those that x and nu are a solution for, with the reaction s.
  Loads loads_of(const Eigen::VectorXd& x, const Eigen::VectorXd& nu, const Eigen::VectorXd& reaction) const;
  void set_loads(Loads loads) { loads_ = std::move(loads); }
  /// Everything closed and sticking.
  ConstraintStates all_closed() const;
  /// Those of x - step s, s what is felt at x and nu, or what is given.
  ConstraintStates states(const Eigen::VectorXd& x, const Eigen::VectorXd& nu) const { return states_at(x, gradient(x, nu)); }
  ConstraintStates states_at(const Eigen::VectorXd& x, const Eigen::VectorXd& gradient) const;
  /// Leaves of the changes from `before` to `now` that of the last place alone, a bound with the disc whose radius follows it, or
  /// a disc. Slip that goes on in much the same direction is no change.
  void keep_one_change(const ConstraintStates& before, ConstraintStates& now) const;
  /// W x + H'nu - b, of softened W.
  Eigen::VectorXd gradient(const Eigen::VectorXd& x, const Eigen::VectorXd& nu) const;
  /// The norm, in that of `own`, of x - P(x - step s), and of what H x - C nu lacks.
  double residual(const Eigen::VectorXd& x, const Eigen::VectorXd& nu) const;
  /// That of x, which a residual is to be small beside; that of e where x is zero, for all may be open.
  double size(const Eigen::VectorXd& x) const;
  /// What the tangential forces at x do against a step of nu, by which the points that they are at slip.
  double friction_power(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const;
  /// The most that a step of nu makes a point slip, and the most that it opens one by.
  double slip(const Eigen::VectorXd& step) const;
  double opening(const Eigen::VectorXd& step) const;
  /// What rounding of W x and C nu makes of the residual.
  double rounding(const Eigen::VectorXd& x, const Eigen::VectorXd& nu) const;
  /// x and nu become the solution of the linear problem with these states. Weak springs hold motions near the nu that comes in,
  /// for states may leave a body free. Where there are many unknowns, the factors of an earlier problem serve as long as they
  /// lead on; x is a start then, and comes out nearer by four figures.
  void solve(const ConstraintStates& states, Eigen::VectorXd& x, Eigen::VectorXd& nu);

  /// The way to the solution without softness, from an x and nu near.
  CentralPath path_from(const Eigen::VectorXd& x, const Eigen::VectorXd& nu) const
  {
    return {*system_, set_, bound_of_, loads_.b, loads_.e, x, nu};
  }

  /// The same with radii that are given: those of x.
  CentralPath path_with_radii(const Eigen::VectorXd& x, const Eigen::VectorXd& nu) const
  {
    std::vector<Bound> bounds(set_.bounds().begin(), set_.bounds().end());
    std::vector<Disc> discs(set_.discs().begin(), set_.discs().end());
    for (std::size_t d = 0; d < discs.size(); ++d) {
      if (bound_of_[d] < 0) continue;
      discs[d].radius = discs[d].coefficient * std::max(x[discs[d].normal], 0.0);
      discs[d].coefficient = 0;
      discs[d].normal = -1;
    }
    const std::vector<int> given(discs.size(), -1);
    return {*system_, FeasibleSet(std::move(bounds), std::move(discs)), given, loads_.b, loads_.e, x, nu};
  }
  bool follows() const
  {
    return std::any_of(bound_of_.begin(), bound_of_.end(), [](int bound) { return bound >= 0; });
  }

  /// Whether there are equations alone, so that there is one guess.
  bool linear() const
  {
    return set_.bounds().empty() &&
           std::all_of(set_.discs().begin(), set_.discs().end(), [](const Disc& disc) { return std::isinf(disc.radius); });
  }

  const ContactSystem& system() const { return *system_; }
  const FeasibleSet& set() const { return set_; }
  Eigen::Index unknowns() const { return loads_.b.size(); }
  Eigen::Index motions() const { return loads_.e.size(); }

 private:
  Guess guess_of(const ConstraintStates& states) const;

  std::unique_ptr<ContactSystem> system_;
  FeasibleSet set_;
  Loads loads_;
  std::vector<int> bound_of_;  // of each disc: the bound of the unknown that its radius follows, -1 if the radius is given
  Eigen::VectorXd own_;        // one compliance for both unknowns of a disc
  double softness_ = 0;
  Eigen::VectorXd softening_;  // compliance that is added
  Eigen::VectorXd step_;
};

}  // namespace mortise::qp
