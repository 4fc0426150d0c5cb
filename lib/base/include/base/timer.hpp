// A scope is a timer: `auto scope = timers.scope("assembly");`. The names are the keys of `time` in summary.json.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/communicator.hpp"

namespace mortise {

/// Wall seconds a stage, summed over its scopes. Stages may nest; each counts its own whole time.
class Timers {
 public:
  class Scope {
   public:
    explicit Scope(double& sum) : sum_(sum), start_(MPI_Wtime()) {}
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope() { sum_ += MPI_Wtime() - start_; }

   private:
    double& sum_;
    double start_;
  };

  /// Times until the returned object dies, which must be before the Timers.
  [[nodiscard]] Scope scope(const std::string& stage) { return Scope(seconds_[stage]); }

  /// Seconds of a stage on this rank so far, scopes still open excluded; 0 for a stage that never ran.
  double seconds(const std::string& stage) const;

  struct Spread {
    std::string stage;
    double min, mean, max;
  };
  /// Every stage over all ranks; the stages must be the same everywhere. Collective.
  std::vector<Spread> spread(const Communicator& comm) const;

 private:
  std::map<std::string, double> seconds_;
};

/// Peak resident memory of this process in bytes.
long long peak_memory();

/// Bytes that this process and others on its machine may still take: what the kernel counts as available, within the limits of
/// the control group and of the address space (ulimit -v).
double available_memory();

}  // namespace mortise
