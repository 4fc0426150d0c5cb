// The warnings of a run.
#pragma once

#include <vector>

#include "base/log.hpp"
#include "base/warning.hpp"

namespace mortise::analysis {

/// Of several states the worst of each kind and place stays.
class Warnings {
 public:
  /// Without printing.
  void add(Warning warning);
  void add(std::vector<Warning> more)
  {
    for (auto& warning : more) add(std::move(warning));
  }
  /// Prints it as well, as it is found: for a run that may not come to its last lines.
  void report(Warning warning, Log& log);
  /// In the order in which they were found first.
  const std::vector<Warning>& all() const { return all_; }

 private:
  std::vector<Warning> all_;
};

}  // namespace mortise::analysis
