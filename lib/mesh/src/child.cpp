#include "child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

#include "base/error.hpp"
#include "base/interruption.hpp"
#include "base/timer.hpp"
#include "sandbox.hpp"

namespace mortise::mesh {

namespace {

// The first byte through the pipe: what follows is what the work sends, or an exit status and a text.
constexpr char result_follows = 'R', error_follows = 'E';

// The rest is of the child alone.
int error_pipe = -1;
bool work_is_sent = false, limited_by_file = false;
std::string file_of_child, remedy_of_child;  // made before anything can go wrong
constexpr std::size_t most_words = 4096;

// In a signal handler too: no memory is taken.
void send_error(ExitStatus status, const char* text, std::size_t size)
{
  if (work_is_sent) return;
  struct {
    char kind = error_follows;
    char status = 0;
  } head;
  head.status = static_cast<char>(status);
  const auto length = static_cast<unsigned long long>(size);
  if (write(error_pipe, &head, sizeof head) < 0 || write(error_pipe, &length, sizeof length) < 0 ||
      write(error_pipe, text, size) < 0)
    _exit(2);
}

void send_error(ExitStatus status, const std::string& text)
{
  send_error(status, text.data(), text.size());
}

void report_refused(const char* what)
{
  static char words[most_words];
  const int size = std::snprintf(words, sizeof words, "%s: wants to %s%s", file_of_child.c_str(), what, remedy_of_child.c_str());
  send_error(ExitStatus::bad_input, words, std::min(static_cast<std::size_t>(size), sizeof words - 1));
}

// What is being thrown, as an error of the file.
void send_current_exception()
{
  const auto prefix = file_of_child + ": gmsh: ";
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
    send_error(ExitStatus::bad_input, prefix + "it gave up without a word");
  } catch (const Error& error) {
    send_error(error.status(), error.what());
  } catch (const std::bad_alloc&) {
    if (limited_by_file)
      send_error(ExitStatus::bad_input,
                 prefix + "it takes more memory than a file of this length can mean; it is likely damaged: write it anew");
    else
      send_error(ExitStatus::machine, prefix + "it took more memory than the machine has for it");
  } catch (const std::string& said) {
    send_error(ExitStatus::bad_input, prefix + said);
  } catch (const std::exception& said) {
    send_error(ExitStatus::bad_input, prefix + said.what());
  } catch (...) {
    send_error(ExitStatus::bad_input, prefix + "it gave up without a word");
  }
}

// gmsh throws strings through its own parallel loops, which ends the process: what it had to say is kept.
[[noreturn]] void report_and_exit()
{
  send_current_exception();
  _exit(0);
}

void limit(__rlimit_resource resource, double value)
{
  rlimit both{};
  if (getrlimit(resource, &both) != 0) return;
  both.rlim_cur = value < static_cast<double>(both.rlim_max) ? static_cast<rlim_t>(value) : both.rlim_max;
  setrlimit(resource, &both);
}

// Bytes that count for RLIMIT_DATA.
double data_segment()
{
  std::ifstream pages("/proc/self/statm");
  double number = 0;
  for (int field = 0; field < 6; ++field) pages >> number;
  return number * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// Signals as a program has them at its start, but for those by which a run is told to end: the parent hears them as well, and
// decides. No file of the parent but the pipe, an end together with the parent.
void stand_alone(pid_t parent)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  for (int number = 1; number < NSIG; ++number) std::signal(number, SIG_DFL);
  for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2}) std::signal(number, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nowhere = open("/dev/null", O_RDWR);
  for (int standard = 0; standard < 3; ++standard) dup2(nowhere, standard);
  dup2(error_pipe, 3);
  error_pipe = 3;
#ifdef SYS_close_range
  if (syscall(SYS_close_range, 4U, ~0U, 0U) == 0) return;
#endif
  for (int file = 4; file < 65536; ++file) close(file);
}

}  // namespace

void Sender::bytes(const void* data, std::size_t size)
{
  if (!work_is_sent) {
    work_is_sent = true;
    if (write(pipe_, &result_follows, 1) != 1) _exit(2);
  }
  for (auto at = static_cast<const char*>(data); size > 0;) {
    const auto written = write(pipe_, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(2);
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

void limit_processor_time(double seconds)
{
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const double before = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1;
  limit(RLIMIT_CPU, seconds > 0 ? std::ceil(before + seconds) : HUGE_VAL);
}

bool confine_child()
{
  return confine(report_refused);
}

Child::Child(Task task, const std::function<void(Sender&)>& work)
    : task_(std::move(task)),
      deadline_(std::chrono::steady_clock::now() + std::chrono::milliseconds(static_cast<long long>(1000 * task_.seconds)))
{
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw Error(ExitStatus::machine, fmt::format("cannot open a pipe: {}", std::strerror(errno)));
  const double memory = available_memory();
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) {
    close(ends[0]), close(ends[1]);
    throw Error(ExitStatus::machine,
                fmt::format("cannot start a process to {} {}: {}", task_.doing, task_.file, std::strerror(errno)));
  }
  if (pid_ == 0) {
    error_pipe = ends[1];
    file_of_child = task_.file;
    remedy_of_child = task_.remedy;
    std::set_terminate(report_and_exit);
    stand_alone(parent);
    limit(RLIMIT_CORE, 0);
    limited_by_file = task_.memory > 0 && task_.memory < memory;
    const double room = limited_by_file ? task_.memory : memory;
    if (std::isfinite(room)) limit(RLIMIT_DATA, data_segment() + room);
    try {
      Sender sender(error_pipe);
      work(sender);
    } catch (...) {
      send_current_exception();
    }
    _exit(0);  // nothing of the parent's is to be ended here
  }
  close(ends[1]);
  pipe_ = ends[0];
  char kind = 0;
  bytes(&kind, 1);
  if (kind == result_follows) return;
  char status = 0;
  bytes(&status, 1);
  const auto message = text();
  stop(SIGKILL);
  throw Error(static_cast<ExitStatus>(status), message);
}

Child::~Child()
{
  stop(SIGKILL);
}

// The child's status when it has ended; it is sent a signal unless that is 0.
int Child::stop(int signal_number)
{
  if (pipe_ >= 0) close(pipe_);
  pipe_ = -1;
  int status = 0;
  if (pid_ < 0) return status;
  if (signal_number != 0) kill(pid_, signal_number);
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

void Child::out_of_time()
{
  stop(SIGKILL);
  throw Error(ExitStatus::bad_input,
              fmt::format("{}: gmsh did not {} it within {:g} seconds{}", task_.file, task_.doing, task_.seconds, task_.longer));
}

void Child::ended()
{
  const int status = stop(0);
  stop_if_requested();  // told together with this process, the child may have been the first to hear it
  const bool killed = WIFSIGNALED(status);
  if (killed && WTERMSIG(status) == SIGXCPU)
    throw Error(
        ExitStatus::bad_input,
        fmt::format("{}: gmsh came to no end with this file, which is likely damaged or cut off; write it anew", task_.file));
  if (killed && WTERMSIG(status) == SIGSYS)  // the C library blocks signals while it starts a program: nobody could tell
    throw Error(ExitStatus::bad_input, fmt::format("{}: wants to start a program{}", task_.file, task_.remedy));
  if (killed && WTERMSIG(status) == SIGKILL)
    throw Error(ExitStatus::machine,
                fmt::format("{}: the process that had to {} it was killed, as the system does when memory runs out", task_.file,
                            task_.doing));
  throw Error(ExitStatus::bad_input,
              fmt::format("{}: gmsh crashed{}; {}", task_.file,
                          killed ? fmt::format(" ({})", strsignal(WTERMSIG(status))) : std::string(), task_.after_crash));
}

void Child::bytes(void* data, std::size_t size)
{
  for (auto at = static_cast<char*>(data); size > 0;) {
    const auto left = std::chrono::duration<double>(deadline_ - std::chrono::steady_clock::now()).count();
    if (left <= 0) out_of_time();
    if (stop_requested() != 0) stop(SIGKILL);
    stop_if_requested();
    pollfd wanted{pipe_, POLLIN, 0};
    if (poll(&wanted, 1, static_cast<int>(std::min(1000 * left + 1, 1000.0))) <= 0) continue;
    const auto got = ::read(pipe_, at, size);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got <= 0) ended();
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

std::size_t Child::count()
{
  unsigned long long n = 0;
  bytes(&n, sizeof n);
  return static_cast<std::size_t>(n);
}

std::string Child::text()
{
  std::vector<char> characters;
  vector(characters);
  return {characters.begin(), characters.end()};
}

}  // namespace mortise::mesh
