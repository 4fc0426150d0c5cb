// Work for a library that may crash, or never come to an end: in a process of its own, which sends what it found through a pipe.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace mortise::mesh {

/// What the work is, for messages: "{doing} {file}", and how long it may take.
struct Task {
  std::string file;
  std::string doing;        ///< "read", "mesh"
  double seconds = 3600;    ///< until the process is stopped
  std::string longer;       ///< how to have more seconds
  std::string after_crash;  ///< advice if it crashes
  double memory = 0;        ///< bytes that no file like this can need; 0: what the machine has
};

/// The child's end of the pipe.
class Sender {
 public:
  explicit Sender(int pipe) : pipe_(pipe) {}
  void bytes(const void* data, std::size_t size);
  /// Of plain values.
  template <class T>
  void vector(const std::vector<T>& values)
  {
    count(values.size());
    bytes(static_cast<const void*>(values.data()), values.size() * sizeof(T));
  }
  void text(const std::string& value) { count(value.size()), bytes(value.data(), value.size()); }
  void count(std::size_t value)
  {
    const auto n = static_cast<unsigned long long>(value);
    bytes(&n, sizeof n);
  }

 private:
  int pipe_;
};

/// A child process at work. It ends with its parent, whatever ends that. Errors are thrown as Error(bad_input) that names the
/// file: what the work threw, or how the child came to its end.
class Child {
 public:
  /// Starts `work` in the child; what it sends is read by the functions below, in the same order. In the child standard input,
  /// output and error are closed and other files of the parent too; its memory is limited to what the machine has.
  Child(Task task, const std::function<void(Sender&)>& work);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// Stops the child if it is still there.
  ~Child();

  void bytes(void* data, std::size_t size);
  template <class T>
  void vector(std::vector<T>& values)
  {
    const auto size = count();
    values.clear();
    for (std::size_t at = 0; at < size;) {  // a count that went wrong must not take all memory at once
      const auto piece = std::min<std::size_t>(size - at, std::size_t{1} << 22);
      values.resize(at + piece);
      bytes(static_cast<void*>(values.data() + at), piece * sizeof(T));
      at += piece;
    }
  }
  std::string text();
  std::size_t count();

 private:
  [[noreturn]] void ended();
  [[noreturn]] void out_of_time();
  int stop(int signal_number);
  Task task_;
  pid_t pid_ = -1;
  int pipe_ = -1;
  std::chrono::steady_clock::time_point deadline_;
};

/// In the child: seconds of processor time, from now, after which the child is stopped as one that will never come to an end; 0:
/// any.
void limit_processor_time(double seconds);

/// In the child: no programs and no writing from here on; `remedy` is part of what the user is told who wanted that. Throws if
/// the system cannot do this.
void confine_child(const std::string& remedy, bool must);

}  // namespace mortise::mesh
