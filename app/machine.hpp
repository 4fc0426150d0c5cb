// What a process asks of the machine before it begins, and what it does when the machine wants it to end.
#pragma once

#include "base/communicator.hpp"

namespace mortise {

/// Gives standard input, output and error a place if they are closed: a file of results that got one of their numbers would take
/// what is printed. To be called before any file is opened.
void occupy_standard_streams();

/// From now on a signal that would end the process (SIGTERM, SIGINT, SIGHUP ...) lets it go on to the next stop_if_requested().
/// If none comes within seconds, or with a second signal, it ends at once, with the exit status "interrupted". What is ignored
/// already, as SIGHUP by nohup, stays so. Files need no care: each has its name only when it is whole. SIGPIPE and SIGXFSZ are
/// ignored, so that writes return errors.
void catch_signals();

/// A fault of the program (SIGSEGV, SIGABRT ...) says so, and ends with the exit status "machine".
void catch_faults();

/// If MPI ends the process between the first and the second of these, the exit status is "machine", whatever MPI's.
void expect_mpi();
void note_mpi_started();

/// Has BLAS take its work space now, since OpenBLAS tries for ever if it finds no room for it, and sees whether there is room for
/// MPI and the first steps. Ends with the exit status "machine" if there is none.
void reserve_memory();

/// Each rank hears from each other one. Where memory is short, MPI may lose what it has no room for without a word, and ranks
/// would wait for ever: then the process ends with the exit status "machine". Collective.
void require_messages(const Communicator& comm);

}  // namespace mortise
