// A process that is told to end goes on to the next place where it looks. Signal handlers write here, long work reads.
#pragma once

#include "base/communicator.hpp"

namespace mortise {

/// Notes that this process is to end because of this signal; 0 takes that back. May be called in a signal handler.
void request_stop(int signal_number);

/// The signal of request_stop(), or 0.
int stop_requested();

/// Throws Error(interrupted) if this process has been told to end, and cancels the alarm that would end it at once. Not
/// collective: for the pieces of long work that runs within `collectively`.
void stop_if_requested();

/// Throws Error(interrupted) on all ranks if any of them has been told to end. Sums one number over the ranks. Collective.
void stop_if_requested(const Communicator& comm);

}  // namespace mortise
