// Face Newton: an active set method that leaves everything about G to exact projections, which cost no product with A. See
// lib/qp/README.md.
#pragma once

#include <deque>
#include <optional>

#include "qp/active_set.hpp"
#include "qp/limits.hpp"
#include "qp/problem.hpp"
#include "qp/slip_law.hpp"
#include "qp/solution.hpp"

namespace mortise::qp {

/// A sequence of problems of one programme, one after the other: recycled directions stay. Refers to the programme's parts and to
/// the preconditioner, which outlive it.
class FaceNewton {
 public:
  /// `preconditioner` may be null. Collective.
  FaceNewton(const Programme& programme, ActiveSetPreconditioner* preconditioner);

  /// Solves until the natural residual ||x - P_C(x - a g)|| / a, a = 1 / ||P A P||, is goal.residual ||P b||, or the error is
  /// what the goal allows, from `start`, or from the feasible point nearest to 0. With a `law`, which may be null, `radii` are
  /// those to begin with: they change at every active set, and what they would change counts as residual too. Not converged if
  /// the products run out, or if it makes no more progress. Collective.
  Solution solve(const RightHandSide& right, std::span<const double> radii, const SlipLaw* law,
                 const std::optional<Solution>& start, const Goal& goal, const Observer& observer);

 private:
  using Limits = limits::FaceNewton;

  struct Pair {
    Vector direction, product, image;  // product: A direction, image: P (A + Sigma) direction
    double energy;                     // direction . image
    bool step;                         // of a descent, and so of use to the preconditioner; else that of a projection
  };
  static constexpr double step_length = 2.0;  // of the gradient step that picks the active set, over ||P A P||

  struct State {
    explicit State(const Teuchos::RCP<const Map>& map) : z(map), g(map), y(map), gy(map) {}
    Vector z, g;   // a point of C and A z - b
    Vector y, gy;  // the solution on its active set, which may lie outside Omega, and A y - b
  };
  struct Run;    // one solve
  struct Trial;  // a point to go on from
  struct Judged;
  Projection project(const Problem& problem, const Vector& to, const Eigen::VectorXd& nu = {})
  {
    return projector_(to, problem.right.e, problem.set, nu);
  }
  // The steps of solve(), in their order.
  void find_norm(const std::optional<Solution>& start, const Observer& observer);
  Trial project_step(Run& run);
  Trial project_step(Run& run, const Vector& to, const Vector* radii_at);
  void improve_soft_start(Run& run, Trial& trial);
  void safeguard(Run& run, Trial& trial);
  Judged judge(const Run& run, const Trial& trial);
  Judged draw_back(Run& run, Trial& trial);
  Projection accept(Run& run, const Trial& trial, Judged judged);
  double rounding_of_motions(const Run& run, const Projection& natural) const;
  void find_error(Run& run, const Projection& natural);
  bool is_compatible(const Run& run) const;
  bool radii_at_rest(const Run& run) const;
  bool contact_converged(const Run& run, const Projection& natural);
  bool is_solved(Run& run, const Projection& natural);
  double size_of_residuals(const Run& run) const;
  bool is_as_asked(const Run& run) const;
  bool is_exact_but_for_residual(const Run& run) const;
  bool is_exact_but_for_states(Run& run, const Projection& natural);
  bool gives_up(Run& run) const;
  void minimise(Run& run, const Trial& trial);
  Solution solution_of(Run run) const;

  void evaluate(const RightHandSide& right, Trial& trial) const;
  double residual_to_reach(const Run& run) const;
  void report(const Run& run, const char* what, bool outer) const;

  void precondition(const ActiveSet& active_set, const Vector& residual, Vector& z) const;
  void measure_discs();
  bool soft_between(const Vector& a, const Vector& ga, const Vector& b, const Vector& gb) const;
  bool improve_start(const Problem& problem, State& state, double energy);
  Vector long_gradient_step(const ActiveSet& active_set, const Vector& y, const Vector& gy) const;
  void recycle(const ActiveSet& active_set, Vector direction, Vector product, bool step);
  bool descend_alone(const ActiveSet& active_set, double goal, const std::function<void()>& report, State& state);
  bool descend(const ActiveSet& active_set, double goal, double weight, bool trusted, const std::function<void()>& report,
               State& state);

  Programme programme_;
  ActiveSetPreconditioner* preconditioner_;
  Projector projector_;
  std::deque<Pair> recycled_directions_;
  std::size_t kept_ = 0;        // of them, the same on every rank
  bool unconstrained_ = false;  // no bounds, no discs: conjugate gradients to the end
  double norm_ = 0;
  std::vector<double> disc_stiffness_;
  mutable int preconditionings_ = 0;
};

}  // namespace mortise::qp
