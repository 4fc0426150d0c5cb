// A process that is told to end goes on to the next place where it looks. Signal handlers write here, long work reads.
#pragma once

#include "base/communicator.hpp"

namespace mortise {

/// This process is to end because of this signal; 0: it is not. May be called in a signal handler.
void request_stop(int signal_number);

/// The signal, or 0.
int stop_requested();

/// Throws Error(interrupted) if this process has been told to end, and takes back the alarm that would end it. Not collective:
/// for the pieces of long work that runs within `collectively`.
void stop_if_requested();

/// The same on all ranks if any of them has been told. One number is summed: cheap, but not free. Collective.
void stop_if_requested(const Communicator& comm);

}  // namespace mortise
