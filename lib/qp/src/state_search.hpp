// The search for the states of all constraints at a solution: by guesses, and from what leads near it where these take turns. See
// condensed_newton.hpp.
#pragma once

#include <climits>
#include <optional>

#include "condensed_programme.hpp"
#include "qp/limits.hpp"

namespace mortise::qp {

class StateSearch {
 public:
  /// `patient`: also with a costly system, if it is no large one, more is tried than takes few factors.
  explicit StateSearch(CondensedProgramme programme, bool patient = false);

  /// From closed contact that sticks, by whatever leads to a solution.
  bool from_anywhere();
  /// From the states of the problem before, which x, nu and the reaction s solve, with all that slips sticking first under other
  /// loads, then along the way from those loads to these, then as they are. Or, unless `solved`, from those of this problem that
  /// x and s have, if one guess tells that they are nearly right.
  bool from(const Eigen::VectorXd& x, const Eigen::VectorXd& nu, const Eigen::VectorXd& reaction, bool solved);
  /// Steps of GMRES leave what settles states, but not all figures: thin plates bend by 1e8 times what decides about contact.
  void polish();

  /// The unknowns that the point's states leave free: those of closed bounds and of discs that stick.
  std::vector<Local> free_forces() const;

  const CondensedNewton::Result& point() const { return point_; }
  Eigen::VectorXd reaction() const { return programme_.gradient(point_.x, point_.nu); }

 private:
  using Limits = limits::States;
  static constexpr int to_the_end = 0;  // no such look back

  // The hardest of the soft contacts that have converged.
  struct Soft {
    double softness, stride;  // to the next one
    ConstraintStates states;
    Eigen::VectorXd nu;
  };

  // The residual over x.
  double off() const { return programme_.residual(point_.x, point_.nu) / programme_.size(point_.x); }
  struct Before {
    Eigen::VectorXd x, nu, reaction;
  };
  void begin_from(const Before& before, bool sticks);
  bool follow_loads(Before before);
  bool from_guessed_states();
  bool find_sparingly();
  bool find_patiently();
  bool guess(int look_back, int most_changes = INT_MAX);
  double solve_for_states(double most);
  void shorten(const Eigen::VectorXd& x_before, const Eigen::VectorXd& nu_before);
  int affordable_guesses() const;
  bool is_unbounded(const Eigen::VectorXd& step, const Eigen::VectorXd& last_step) const;
  bool slides();
  bool harden(int guesses, int failures);
  bool follow_path();
  bool repeat_paths();
  bool change_steps();
  void start_soft();
  template <class Visit>
  static bool walk(CentralPath& path, double last, const Visit& is_end);

  CondensedProgramme programme_;
  ConstraintStates states_;
  bool sparing_;  // with factors: what takes few is all that is tried,
  bool patient_;  // at first
  CondensedNewton::Result point_;
  bool unbounded_ = false;     // how the last guesses ended,
  Eigen::VectorXd last_step_;  // and their last step of nu
  int first_changes_ = 0;      // of states, that the first of the last guesses made
  double softest_ = 0;
  std::optional<Soft> soft_;
};

}  // namespace mortise::qp
