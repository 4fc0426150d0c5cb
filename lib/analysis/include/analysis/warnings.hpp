// The warnings of a run.
#pragma once

#include <vector>

#include "base/log.hpp"
#include "base/warning.hpp"

namespace mortise::analysis {

/// All warnings found so far; of several states the worst of each kind and place.
class Warnings {
 public:
  /// Adds one without printing it.
  void add(Warning warning);
  void add(std::vector<Warning> more)
  {
    for (auto& warning : more) add(std::move(warning));
  }
  /// Adds it and prints it at once, for a run that may not come to its last lines.
  void report(Warning warning, Log& log);
  /// In the order in which they were found first.
  const std::vector<Warning>& all() const { return all_; }

 private:
  std::vector<Warning> all_;
};

}  // namespace mortise::analysis
