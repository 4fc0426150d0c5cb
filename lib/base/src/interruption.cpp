#include "base/interruption.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "base/error.hpp"

namespace mortise {

namespace {

volatile std::sig_atomic_t told = 0;

[[noreturn]] void end(int signal_number)
{
  alarm(0);
  throw Error(ExitStatus::interrupted,
              fmt::format("The run was told to end (SIG{}) before it was solved.", sigabbrev_np(signal_number)));
}

}  // namespace

void request_stop(int signal_number)
{
  told = signal_number;
}

int stop_requested()
{
  return told;
}

void stop_if_requested()
{
  if (told != 0) end(told);
}

void stop_if_requested(const Communicator& comm)
{
  int first = told;
  PMPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MAX, comm.mpi());  // not counted among what the method sends
  if (first != 0) end(first);
}

}  // namespace mortise
