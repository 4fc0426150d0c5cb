#include "base/log.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace mortise {

namespace {

// mpirun gives its processes a pseudo-terminal wherever their output goes, so there the wrapper script must say what stands
// behind it.
bool on_terminal(std::FILE* out)
{
  if (const char* told = std::getenv("MORTISE_TERMINAL")) return std::string_view(told) == "1";
  return isatty(fileno(out)) != 0 && std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr;
}

}  // namespace

Log::Log(const Communicator& comm, std::FILE* out) : out_(comm.root() ? out : nullptr)
{
  terminal_ = out_ && on_terminal(out_);
  next_ = MPI_Wtime() + (terminal_ ? 0.1 : 10.0);
}

void Log::write(const std::string& text)
{
  end_progress();
  fmt::print(out_, "{}\n", text);
  std::fflush(out_);
}

bool Log::progress_due()
{
  const double now = MPI_Wtime();
  if (now < next_) return false;
  next_ = now + (terminal_ ? 0.1 : 10.0);
  return true;
}

void Log::write_progress(const std::string& text)
{
  fmt::print(out_, "{}{}{}", terminal_ ? "\r" : "", text, terminal_ ? "\033[K" : "\n");
  std::fflush(out_);
  moving_ = terminal_;
}

void Log::end_progress()
{
  if (moving_) fmt::print(out_, "\r\033[K");
  moving_ = false;
}

}  // namespace mortise
