// What every stage of a run may need from its surroundings, handed down by reference: no globals.
#pragma once

#include "base/communicator.hpp"
#include "base/log.hpp"
#include "base/timer.hpp"

namespace mortise {

/// Refers to its parts, which outlive it.
struct Context {
  const Communicator& comm;
  Log& log;
  Timers& timers;
};

}  // namespace mortise
