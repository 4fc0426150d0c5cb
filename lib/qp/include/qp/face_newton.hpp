// Face Newton: an active set method that leaves everything about G to exact projections, which cost no product with A. See
// lib/qp/README.md.
#pragma once

#include <deque>
#include <optional>

#include "qp/face.hpp"
#include "qp/problem.hpp"
#include "qp/solution.hpp"

namespace mortise::qp {

/// For friction whose bounds depend on the solution. Both are collective.
struct Renewal {
  /// Renews the radii of the problem's set for the point `x` if `apply`; returns the norm of what changes, or would change.
  std::function<double(const Vector& x, bool apply)> renew;
  /// Goes half way back to earlier radii, because the renewed ones leave no feasible point.
  std::function<void()> retreat;
};

/// A sequence of similar problems, one after the other: what was learnt about A stays. Refers to the problem and to the
/// preconditioner, which outlive it.
class FaceNewton {
 public:
  /// `preconditioner` may be null. Collective.
  FaceNewton(const Problem& problem, FacePreconditioner* preconditioner);

  /// Solves until the natural residual ||x - P_C(x - a g)|| / a, a = 1 / ||P A P||, is goal.residual ||P b||, or the error is
  /// what the goal allows, from `start`, or from the feasible point nearest to 0. With `renewal` the radii change at every face,
  /// and what they would change counts as residual too. Not converged if the products run out, or if it makes no more progress.
  /// Collective.
  Solution solve(const std::optional<Solution>& start, const Goal& goal, const Renewal* renewal, const Observer& observer);

 private:
  struct Pair {
    Vector direction, product, image;  // product: A direction, image: P (A + Sigma) direction
    double energy;                     // direction . image
    bool step;                         // of a descent, and so of use to the preconditioner; else that of a projection
  };
  static constexpr double step_length = 2.0;      // of the gradient step that picks the face, over ||P A P||
  static constexpr double inner_reduction = 0.2;  // of the projected gradient on one face

  struct State {
    explicit State(const Teuchos::RCP<const Map>& map) : z(map), g(map), y(map), gy(map) {}
    Vector z, g;   // a point of C and A z - b
    Vector y, gy;  // the solution on its face, which may lie outside Omega, and A y - b
  };
  void precondition(const Face& face, const Vector& residual, Vector& z) const;
  bool soft_between(const Vector& a, const Vector& ga, const Vector& b, const Vector& gb) const;
  bool look_for_start(State& state, double energy);
  Vector look_beyond(const Face& face, const State& state) const;
  void learn(const Face& face, const Vector& direction, const Vector& product, bool step);
  bool descend_alone(const Face& face, double goal, const std::function<void()>& report, State& state);
  bool descend(const Face& face, double goal, double weight, bool trusted, const std::function<void()>& report, State& state);

  const Problem& problem_;
  FacePreconditioner* preconditioner_;
  Projector projector_;
  std::deque<Pair> known_;
  std::size_t kept_ = 0;    // of them, the same on every rank
  bool only_face_ = false;  // no bounds, no discs: conjugate gradients to the end
  double norm_ = 0;
  mutable int preconditionings_ = 0;
};

}  // namespace mortise::qp
