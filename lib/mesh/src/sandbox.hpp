// What a process may no longer do, once and for all: start programs, write files, reach other processes or the network.
#pragma once

namespace mortise::mesh {

/// From here on the calling process can compute, read files and write to what it has open; other calls of the system fail as if
/// this one did not have them. Those that start a program or change a file end the process instead, after told("..") with words
/// for what it was about to do; `told` must be safe in a signal handler. False if the system cannot confine a process so.
bool confine(void (*told)(const char* what));

}  // namespace mortise::mesh
