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

  /// Adds a row, or moves the line, for what a solver reports: `step`, `change` as of analysis::Observer. Throws
  /// Error(interrupted) if a signal asked the run to end. Collective.
  void note(const model::LoadState& state, int step, double change, const qp::Progress& p);
  /// Takes over the text of the history of a run that is resumed: the rows of states before the first one that is solved here.
  void take_up(const std::string& text);
  /// The whole of history.csv.
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
