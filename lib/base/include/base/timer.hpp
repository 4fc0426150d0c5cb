// A scope is a timer, and counts what is sent while it is open: `auto scope = timers.scope("assembly");`. The names are the keys
// of `time` in summary.json.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/traffic.hpp"

namespace mortise {

/// Wall seconds and traffic a stage, summed over its scopes. Stages may nest; each counts all that is within.
class Timers {
  struct Stage {
    double seconds = 0;
    Traffic traffic = {};
  };

 public:
  class Scope {
   public:
    explicit Scope(Stage& sum) : sum_(sum), start_(MPI_Wtime()), before_(mortise::traffic()) {}
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope()
    {
      sum_.seconds += MPI_Wtime() - start_;
      sum_.traffic += mortise::traffic() - before_;
    }

   private:
    Stage& sum_;
    double start_;
    Traffic before_;
  };

  /// Times until the returned object dies, which must be before the Timers.
  [[nodiscard]] Scope scope(const std::string& stage) { return Scope(stages_[stage]); }

  /// Seconds of a stage on this rank so far, scopes still open excluded; 0 for a stage that never ran.
  double seconds(const std::string& stage) const;
  /// What this rank sent in a stage so far, scopes still open excluded.
  Traffic traffic(const std::string& stage) const;

  struct Spread {
    std::string stage;
    double min, mean, max;  ///< seconds, over the ranks
  };
  /// Every stage over all ranks; the stages must be the same everywhere. Collective.
  std::vector<Spread> spread(const Communicator& comm) const;

 private:
  std::map<std::string, Stage> stages_;
};

/// Peak resident memory of this process in bytes.
long long peak_memory();

/// Bytes that this process and others on its machine may still take: what the kernel counts as available, within the limits of
/// the control group and of the address space (ulimit -v).
double available_memory();

}  // namespace mortise
