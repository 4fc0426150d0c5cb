#include "machine.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "base/interruption.hpp"

extern "C" void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
                       const double*, const int*, const double*, double*, const int*);

namespace mortise {

namespace {

constexpr unsigned grace = 10;           // seconds until the process ends though it has come to no safe place
constexpr double message_patience = 60;  // seconds until the first messages have come
constexpr int blas_patience = 500000;    // microseconds of CPU, for what takes some tens of them

// Bytes that MPI and a run of a few cells take. Libraries that find no room end in ways of their own, so it is asked for first.
constexpr std::size_t first_steps = 64'000'000;

pid_t owner = 0;  // children inherit handlers, but have their own ways to end

// In a signal handler.
[[noreturn]] void end_with(const char* text, ExitStatus status = ExitStatus::machine)
{
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
  _exit(static_cast<int>(status));
}

[[noreturn]] void end_interrupted()
{
  end_with("mortise: ended by a signal; results of the run are not complete.\n", ExitStatus::interrupted);
}

void end_by_default(int signal_number)
{
  std::signal(signal_number, SIG_DFL);
  raise(signal_number);
}

void note(int signal_number)
{
  if (getpid() != owner) return end_by_default(signal_number);
  if (stop_requested() != 0) end_interrupted();
  request_stop(signal_number);
  alarm(grace);
}

void end_without_cleanup(int)
{
  end_interrupted();
}

void report_fault(int signal_number)
{
  if (getpid() != owner) return end_by_default(signal_number);
  switch (signal_number) {
    case SIGBUS:
      end_with("mortise: internal error (SIGBUS), or no room for shared memory (/dev/shm).\n");
    case SIGABRT:
      end_with("mortise: internal error (SIGABRT), or out of memory, if a line above says so or memory is limited (ulimit).\n");
    case SIGFPE:
      end_with("mortise: internal error (SIGFPE). Please report it with the deck and the mesh.\n");
    case SIGILL:
      end_with(
          "mortise: this processor lacks instructions that the program was built with (SIGILL); build it here, see "
          "MORTISE_ARCH.\n");
    default:
      end_with(
          "mortise: internal error (SIGSEGV), or out of memory, if memory is limited (ulimit). Otherwise please report it with "
          "the "
          "deck and the mesh.\n");
  }
}

void no_room_for_blas(int)
{
  end_with(
      "mortise: out of memory: there is no room for the work space of BLAS (some 130 MB of address space); raise the limit of "
      "memory (ulimit -v).\n");
}

void handle(int signal_number, void (*handler)(int), int flags)
{
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
  // The launcher holds signals back until there is a handler.
  sigset_t now_handled;
  sigemptyset(&now_handled);
  sigaddset(&now_handled, signal_number);
  sigprocmask(SIG_UNBLOCK, &now_handled, nullptr);
}

bool is_ignored(int signal_number)
{
  struct sigaction now {};
  return sigaction(signal_number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

bool mpi_started = false;

// MPI may call exit() where it cannot start, with a status of its own.
void report_mpi_failure()
{
  if (!mpi_started)
    end_with(
        "mortise: MPI cannot be started: out of memory, or no room for its files (/dev/shm, the temporary folder); lines above "
        "say "
        "more.\n");
}

}  // namespace

void occupy_standard_streams()
{
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF) open("/dev/null", O_RDWR);  // takes the lowest free number: this one
}

void catch_signals()
{
  owner = getpid();
  for (const int signal_number : {SIGPIPE, SIGXFSZ}) std::signal(signal_number, SIG_IGN);
  for (const int signal_number : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU})
    handle(signal_number, is_ignored(signal_number) ? SIG_IGN : note, SA_RESTART);
  handle(SIGALRM, end_without_cleanup, 0);
}

void catch_faults()
{
  owner = getpid();
  // A stack that has overflowed cannot carry its handler.
  static char stack[1 << 16];
  const stack_t other{stack, 0, sizeof stack};
  sigaltstack(&other, nullptr);
  for (const int signal_number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSYS})
    handle(signal_number, report_fault, SA_ONSTACK);
}

void expect_mpi()
{
  std::atexit(report_mpi_failure);
}

void note_mpi_started()
{
  mpi_started = true;
}

void reserve_memory()
{
  handle(SIGPROF, no_room_for_blas, 0);
  itimerval timer{};
  timer.it_value.tv_usec = blas_patience;
  setitimer(ITIMER_PROF, &timer, nullptr);
  const int n = 192;  // products of small matrices go without
  const double one = 1;
  const std::vector<double> a(n * n, 1.0);
  std::vector<double> product(n * n, 0.0);
  dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, a.data(), &n, &one, product.data(), &n);
  timer.it_value.tv_usec = 0;
  setitimer(ITIMER_PROF, &timer, nullptr);
  std::signal(SIGPROF, SIG_DFL);
  void* const room = mmap(nullptr, first_steps, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED)
    end_with(
        "mortise: out of memory: there is no room for the first steps (some 60 MB of address space beside the libraries and "
        "BLAS); "
        "raise the limit of memory (ulimit -v).\n");
  munmap(room, first_steps);
}

void require_messages(const Communicator& comm)
{
  if (comm.size() == 1) return;
  constexpr std::size_t numbers = 256;  // to each rank
  const auto ranks = static_cast<std::size_t>(comm.size());
  const std::vector<int> out(ranks * numbers, 0);
  std::vector<int> in(out.size());
  MPI_Request request;
  PMPI_Ialltoall(out.data(), numbers, MPI_INT, in.data(), numbers, MPI_INT, comm.mpi(), &request);
  const double start = MPI_Wtime();
  for (int done = 0; done == 0;) {
    PMPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0 && MPI_Wtime() - start > message_patience)
      end_with(
          "mortise: out of memory, or MPI is not set up: ranks get no messages from each other, though MPI has started; raise "
          "the limit "
          "of memory (ulimit -v), or see that mpirun reaches all machines.\n");
    if (done == 0) std::this_thread::yield();
  }
}

}  // namespace mortise
