// What a run says on the terminal: one rank speaks, in short physical lines, and one line moves while the solver iterates.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "base/communicator.hpp"

namespace mortise {

class Log {
 public:
  /// Rank 0 writes to `out`; a null `out`, and every other rank, is silent.
  Log(const Communicator& comm, std::FILE* out);
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  ~Log() { end_progress(); }

  /// Writes a line of its own, formatted as by fmt. Rank 0 alone writes, others may call it.
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args)
  {
    if (out_) write(fmt::format(format, std::forward<Args>(args)...));
  }
  /// The same, after "warning: ".
  template <class... Args>
  void warning(fmt::format_string<Args...> format, Args&&... args)
  {
    if (out_) write("warning: " + fmt::format(format, std::forward<Args>(args)...));
  }

  /// Replaces the moving line. On a terminal it is rewritten in place at most ten times a second; elsewhere it is written
  /// as a line of its own at most once every ten seconds, so that a log file stays short.
  template <class... Args>
  void progress(fmt::format_string<Args...> format, Args&&... args)
  {
    if (out_ && progress_due()) write_progress(fmt::format(format, std::forward<Args>(args)...));
  }
  /// Leaves the moving line as it is; what follows begins on a new one.
  void end_progress();

 private:
  void write(const std::string& text);
  void write_progress(const std::string& text);
  bool progress_due();

  std::FILE* out_ = nullptr;
  bool terminal_ = false;
  bool moving_ = false;
  double next_ = 0;
};

}  // namespace mortise
