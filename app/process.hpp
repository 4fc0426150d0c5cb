// What lies round the method: MPI, signals, exceptions and exit codes.
#pragma once

#include "base/context.hpp"
#include "base/error.hpp"
#include "command_line.hpp"

namespace mortise {

/// Starts MPI, reads the command line, answers --help, --version and --schema, else runs `solve` on all ranks. Returns the exit
/// status of the process; what goes wrong is said on standard error.
int run_process(int argc, char** argv, ExitStatus (*solve)(const CommandLine&, const Context&));

}  // namespace mortise
