// The assembly on its way through the load states: prepared once, then one equilibrium after the other. Factorizations,
// multipliers and what was learnt about F go from each to the next.
#pragma once

#include <memory>
#include <optional>

#include "model.hpp"

namespace mortise {

/// Heavy: neither copies nor moves.
class Simulation {
 public:
  /// Supports and contacts of the first state. `spent`: products of an earlier attempt. The other arguments outlive it.
  /// Collective.
  Simulation(const Deck& deck, const partition::Decomposition& decomposition, const Model& model, const LoadState& first,
             int spent, const Context& context);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Stiffness and factors of the subdomains; `copies` as of Model::congruent. Collective.
  void factorize(const std::vector<partition::CopyOf>& copies);
  /// Finds the equilibrium of a state: the first one first, then the others in their order. Throws Error(no_equilibrium).
  /// Collective.
  void solve(const LoadState& state, const friction::Observer& observer);
  /// From now on solve() gives up after so many products, see friction::Result::gave_up.
  void lose_patience_after(std::optional<int> products) { patience_ = products; }
  /// Products of all solves, also of one that threw.
  int multiplications() const { return solver_ ? multiplications_before_ + solver_->multiplications() : multiplications_; }
  /// Friction counts slip from the state that was solved last. `displacement` as of DualProblem. Collective.
  void settle(const std::vector<Eigen::VectorXd>& displacement);

  /// What acts: that of the last solve().
  const LoadState& state() const { return state_; }
  const constraint::Constraints& constraints() const { return constraints_; }
  const std::vector<contact::Pair>& pairs() const { return pairs_; }
  /// Of each contact, as the mesh lies. The same on every rank.
  const std::vector<contact::InitialGap>& initial_gaps() const { return initial_gaps_; }
  const feti::Floating& floating() const { return floating_; }
  const partition::Interface& interface() const { return interface_; }
  const feti::DualProblem& problem() const { return *problem_; }
  const friction::Result& solved() const { return *solved_; }

 private:
  void constrain(const LoadState& state);
  bool move_constraints(const LoadState& state);
  void place_rows();  // where their nodes live, once that is known
  void build_problem();
  void find_cuts();
  void rebuild(const LoadState& state, bool moved);

  const Deck& deck_;
  const partition::Decomposition& decomposition_;
  const Model& model_;
  const Context& context_;
  LoadState state_;  // the constraints' own
  std::vector<std::vector<Global>> support_nodes_;
  std::vector<mesh::Surface> support_surfaces_;
  std::vector<constraint::SupportOptions> supports_;
  constraint::Constraints constraints_;
  std::vector<contact::Pair> pairs_;
  std::vector<contact::InitialGap> initial_gaps_;
  std::optional<partition::NodeDirectory> directory_;
  partition::Interface interface_;
  feti::Floating floating_;
  std::unique_ptr<feti::DualProblem> problem_;
  std::unique_ptr<friction::Solver> solver_;
  std::unique_ptr<friction::Result> solved_;              // of the state before, while a new one is being solved
  std::vector<double> shortenings_;                       // of the preloaded contacts in the state before
  int multiplications_ = 0, multiplications_before_ = 0;  // of all problems, of those before this one
  std::optional<int> patience_;
};

}  // namespace mortise
