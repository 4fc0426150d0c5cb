// mortise DECK: multibody contact of linear elasticity by Total FETI.
//
//     deck -> mesh -> bodies -> subdomains -> constraint rows -> dual problem -> QP (inside a friction loop)
//          -> multipliers -> displacements -> fields -> files
//
// Sample runs:  mortise inputs/hertz_sphere/hertz_sphere.yaml
//               mpirun -n 2 mortise inputs/cantilever_3d/cantilever_3d.yaml --set solver.tolerance=1e-6
#include <dlfcn.h>
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>

#include "command_line.hpp"
#include "io/output_directory.hpp"
#include "machine.hpp"
#include "run.hpp"

namespace {

using namespace mortise;

constexpr std::size_t longest_deck = 50000000;  // bytes

// The text of the deck, read by one rank.
std::string read_text(const std::string& file, const Communicator& comm)
{
  std::string text;
  collectively(comm, [&] {
    if (!comm.root()) return;
    if (std::filesystem::is_directory(file)) throw Error(ExitStatus::bad_input, file + ": is a directory; expected a deck");
    std::ifstream stream(file);
    if (!stream) throw Error(ExitStatus::bad_input, file + ": cannot be read: " + std::strerror(errno));
    for (std::array<char, 4096> part; stream && text.size() <= longest_deck;) {
      stream.read(part.data(), part.size());
      text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (text.size() > longest_deck)
      throw Error(ExitStatus::bad_input, fmt::format("{}: is longer than {} MB, which no deck is; expected a text of some pages "
                                                     "(meshes are named in it, by mesh.file)",
                                                     file, longest_deck / 1000000));
  });
  comm.broadcast(text);
  return text;
}

// What the user asked for is the text itself: if it cannot be written, that is a failure.
ExitStatus shown(ExitStatus status)
{
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
  std::cerr << "mortise: the output cannot be written\n";
  return status == ExitStatus::solved ? ExitStatus::machine : status;
}

// CHOLMOD starts threads of its own unless OpenMP, where some library has brought it, is told not to.
void forbid_threads()
{
  if (auto* limit = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"))) limit(0);
}

// A rank that no launcher started needs no daemon of MPI beside it, and no folder in the temporary one, which may be full.
void be_alone()
{
  for (const char* launched : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_RANK"})
    if (std::getenv(launched)) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
}

ExitStatus solve(const CommandLine& command_line, const Communicator& comm)
{
  Timers timers;
  Log log(comm, stdout);
  const Context context{comm, log, timers};
  deck::Document document(read_text(command_line.deck, comm), command_line.deck, command_line.settings);
  Deck deck = read_deck(document, command_line.output);
  deck.mesh.allow_scripts = command_line.allow_scripts;
  try {
    document.check();
  } catch (const Error&) {
    if (!command_line.check) io::set_aside_summary(deck.output.directory, comm);
    throw;
  }
  return run(deck, document, command_line, context);
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

int main(int argc, char** argv)
{
  reserve_memory();
  setenv("OMPI_MCA_opal_signal", "", 0);  // faults are ours to tell
  be_alone();
  expect_mpi();
  int no_arguments = 1;  // but the program's name: Kokkos would answer --help and take other options for its own
  const Tpetra::ScopeGuard tpetra(&no_arguments, &argv);
  note_mpi_started();
  forbid_threads();
  const Communicator comm;
  const Parsed parsed = parse_command_line(argc, argv);
  if (!parsed.command_line) {
    if (comm.root()) (parsed.status == 0 ? std::cout : std::cerr) << parsed.text;
    return static_cast<int>(shown(static_cast<ExitStatus>(parsed.status)));
  }
  if (parsed.command_line->schema) {
    if (comm.root()) std::cout << deck_schema();
    return static_cast<int>(shown(ExitStatus::solved));
  }
  try {
    const ExitStatus status = solve(*parsed.command_line, comm);
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
}
