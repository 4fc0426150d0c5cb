// history.csv, a row for each outer iteration, and the line that moves while it iterates.
#pragma once

#include <string>
#include <vector>

#include "base/context.hpp"
#include "model/deck.hpp"
#include "qp/options.hpp"
#include "qp/solution.hpp"

namespace mortise {

class History {
 public:
  /// Refers to its arguments.
  History(const qp::Options& options, const Context& context) : options_(options), context_(context) {}

  /// Ends the run here if a signal asked for that. Collective.
  void note(const model::LoadState& state, int step, double change, const qp::Progress& p);
  /// The rows of a run that is resumed: those of the states before the first one that is solved here stay.
  void take_up(const std::string& text);
  std::string text() const;

 private:
  double target(const qp::Progress& p, double residual) const;
  std::string time_left(const model::LoadState& state, double residual, double target);

  const qp::Options& options_;
  const Context& context_;
  long long inner_ = 0;                                 // calls within outer iterations, the same on all ranks
  double state_ = -1, start_ = 0, first_residual_ = 0;  // the state's time; when it began, and with which residual
  std::string active_;                                  // contact nodes of all ranks at the end of the last outer iteration
  struct Row {
    double time;
    std::string text;
  };
  std::vector<Row> earlier_;  // of a run before
  std::string rows_;
};

}  // namespace mortise
