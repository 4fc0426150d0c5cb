// What one solve of face Newton holds, and hands from step to step.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "qp/face_newton.hpp"

namespace mortise::qp {

// Whether normal forces are at rest: by how much they are still to change, if they change like the error.
class ContactForces {
 public:
  explicit ContactForces(const Problem& problem) : problem_(problem) {}

  // Relative, of the forces at x, whose error is `error`; infinite where that cannot be told. Collective.
  double change_to_come(const Vector& x, double error)
  {
    const auto values = view(x);
    std::vector<double> now;
    std::vector<double> sums(2, 0.0);
    for (const auto& bound : problem_.set.bounds()) {
      now.push_back(values[bound.index]);
      sums[0] += now.back() * now.back();
      if (!before_.empty()) sums[1] += std::pow(now.back() - before_[now.size() - 1], 2);
    }
    problem_.equality.communicator().sum_in_place(sums);
    const double part = error / error_;
    const bool known = error_ > 0 && part < 1;
    before_ = std::move(now);
    error_ = error;
    if (sums[0] == 0 || sums[1] == 0) return known || sums[0] == 0 ? 0.0 : std::numeric_limits<double>::infinity();
    return known ? std::sqrt(sums[1] / sums[0]) * part / (1 - part) : std::numeric_limits<double>::infinity();
  }

 private:
  const Problem& problem_;
  std::vector<double> before_;
  double error_ = 0;
};

// 1/2 x'A x - b'x, from the gradient A x - b at x.
inline double energy_of(const Vector& b, const Vector& x, const Vector& gradient)
{
  return 0.5 * (x.dot(gradient) - x.dot(b));
}

// One solve: what it was called with, where it stands, and how it went so far.
struct FaceNewton::Run {
  const Problem& problem;
  const std::optional<Solution>& start;
  const Goal& goal;
  FollowedRadii* followed;  // null: radii stay
  const Observer& observer;
  Solution result;
  State state;
  ContactForces contact;
  double size = 1;                  // that residuals are relative to: ||P b||
  double energy = 0;                // of z
  double residual = 0;              // natural, of z
  double mismatch = 0;              // of radii at z, as a residual
  Eigen::VectorXd nu = {};          // a start for the next projection
  FeasibleSet::Active active = {};  // how many constraints are
  bool moved = false;               // y differs from z
  // y and z after a longer step, where bounds follow the solution.
  std::optional<Vector> beyond = {}, beyond_z = {};
  std::deque<double> last_residuals = {};  // worst() of some steps, there
  double active_set_tolerance = 0;
  double first_error = 0, allowed = -1;  // negative: not asked for yet
  bool doubtful = false;                 // a small residual beside a large error
  double best = std::numeric_limits<double>::infinity(), best_error = best;
  int since_best = 0;  // active sets

  // The point that is to be the solution if nothing better comes of it, see is_exact_but_for_states().
  struct Kept {
    explicit Kept(const Run& run)
        : z(run.state.z, Teuchos::Copy), g(run.state.g, Teuchos::Copy), result(run.result), residual(run.residual)
    {
    }
    Vector z, g;
    Solution result;
    double residual;
  };
  std::optional<Kept> exact_but_for_states = {};
  void go_back()
  {
    auto& point = *exact_but_for_states;
    state.z.assign(point.z);
    state.g.assign(point.g);
    point.result.outer_iterations = result.outer_iterations;
    point.result.preconditionings = result.preconditionings;
    result = std::move(point.result);
    result.converged = true;
    residual = point.residual;
  }

  double worst() const { return std::max(residual, mismatch); }
  // The largest of the last residuals; infinite as long as there are none.
  double highest() const
  {
    if (last_residuals.empty()) return std::numeric_limits<double>::infinity();
    return *std::max_element(last_residuals.begin(), last_residuals.end());
  }
  static constexpr std::size_t remembered = 10;
  bool first() const { return result.outer_iterations == 0; }
};

// How far a point is from a solution: the natural projection there, its residual and what radii would change, as a residual.
struct FaceNewton::Judged {
  Projection natural;
  double residual, mismatch;

  double worst() const { return std::max(residual, mismatch); }
};

// The point of C that comes next, and what led there.
struct FaceNewton::Trial {
  Projection next;
  double step;             // along the gradient, before the projection
  Vector gradient;         // A x - b at the point
  double energy = 0;       // of the point
  double part_of_way = 1;  // from z to y, where the step began
};

}  // namespace mortise::qp
