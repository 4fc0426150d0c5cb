// Where tests stand: their ranks, and a log that nobody reads.
#pragma once

#include "base/context.hpp"

namespace mortise {

/// What a stage of a run needs from its surroundings. Parts refer to each other: neither copies nor moves.
struct Quiet {
  Communicator comm;
  Timers timers;
  Log log{comm, nullptr};
  Context context{comm, log, timers};

  explicit Quiet(MPI_Comm ranks = MPI_COMM_WORLD) : comm(ranks) {}
};

/// All ranks.
inline const Communicator& world()
{
  static const Communicator comm;
  return comm;
}

}  // namespace mortise
