#include "process.hpp"

#include <dlfcn.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>
#include <optional>

#include "base/timer.hpp"
#include "machine.hpp"
#include "model/deck.hpp"

namespace mortise {

namespace {

// What the user asked for is the text itself: if it cannot be written, that is a failure.
ExitStatus shown(ExitStatus status)
{
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
  std::cerr << "mortise: the output cannot be written\n";
  return status == ExitStatus::solved ? ExitStatus::machine : status;
}

// Shows, on the root, what needs no deck; nothing if the command line has one to solve.
std::optional<ExitStatus> show_text(const Parsed& parsed, bool root = true)
{
  if (!parsed.command_line) {
    if (root) (parsed.status == 0 ? std::cout : std::cerr) << parsed.text;
    return shown(static_cast<ExitStatus>(parsed.status));
  }
  if (!parsed.command_line->schema) return {};
  if (root) std::cout << model::deck_schema();
  return shown(ExitStatus::solved);
}

// CHOLMOD starts threads of its own unless OpenMP, where some library has brought it, is told not to; VTK, to find the range of a
// field.
void forbid_threads()
{
  setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 0);
  if (auto* limit = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"))) limit(0);
}

// Whether no launcher has started this rank beside others.
bool alone()
{
  const auto variables = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_RANK"};
  return std::none_of(variables.begin(), variables.end(), [](const char* name) { return std::getenv(name) != nullptr; });
}

// Such a rank needs no daemon of MPI beside it, and no folder in the temporary one, which may be full.
void be_alone()
{
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  // Nor does it look for graphics cards, which brings the libraries of X11 and OpenCL, for other devices, or at each processor in
  // turn, on which it would run for that.
  setenv("HWLOC_PLUGINS_BLACKLIST", "hwloc_gl.so,hwloc_opencl.so,hwloc_pci.so,hwloc_xml_libxml.so", 0);
  setenv("HWLOC_COMPONENTS", "-linuxio,-x86", 0);
}

// Run before the libraries set themselves up, which takes a while, may fail for lack of memory, and opens files.
void prepare_process(int, char**, char**)
{
  occupy_standard_streams();
  catch_signals();
  catch_faults();
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)(int, char**, char**) = prepare_process;

}  // namespace

int run_process(int argc, char** argv, ExitStatus (*solve)(const CommandLine&, const Context&))
{
  const Parsed parsed = parse_command_line(argc, argv);
  if (alone()) {
    if (const auto status = show_text(parsed)) return static_cast<int>(*status);  // MPI is not needed for that
    be_alone();
  }
  reserve_memory();
  setenv("OMPI_MCA_opal_signal", "", 0);  // faults are ours to tell
  expect_mpi();
  int no_arguments = 1;  // but the program's name: Kokkos would answer --help and take other options for its own
  const Tpetra::ScopeGuard tpetra(&no_arguments, &argv);
  note_mpi_started();
  forbid_threads();
  const Communicator comm;
  require_messages(comm);
  if (const auto status = show_text(parsed, comm.root())) return static_cast<int>(*status);
  try {
    Timers timers;
    Log log(comm, stdout);
    const ExitStatus status = solve(*parsed.command_line, Context{comm, log, timers});
    return static_cast<int>(parsed.command_line->check ? shown(status) : status);
  } catch (const Error& error) {  // thrown on all ranks alike
    std::cout << std::flush;
    if (comm.root()) std::cerr << error.what() << std::endl;
    return static_cast<int>(error.status());
  } catch (const std::bad_alloc&) {  // perhaps on this rank alone: the others would wait for ever
    std::cerr << "mortise: out of memory on rank " << comm.rank() << std::endl;
  } catch (const std::exception& error) {
    std::cerr << "mortise: rank " << comm.rank() << ": " << error.what() << std::endl;
  }
  MPI_Abort(comm.mpi(), static_cast<int>(ExitStatus::machine));
  return static_cast<int>(ExitStatus::machine);
}

}  // namespace mortise
