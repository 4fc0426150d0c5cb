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

// A terminal that went away or a full disk must not end the run: what cannot be written is lost, and std::ferror tells.
void put(std::FILE* out, const std::string& text)
{
  std::fwrite(text.data(), 1, text.size(), out);
  std::fflush(out);
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
  put(out_, text + "\n");
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
  put(out_, fmt::format("{}{}{}", terminal_ ? "\r" : "", text, terminal_ ? "\033[K" : "\n"));
  moving_ = terminal_;
}

void Log::end_progress()
{
  if (moving_) put(out_, "\r\033[K");
  moving_ = false;
}

}  // namespace mortise
