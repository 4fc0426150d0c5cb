// Numbers as bytes, to be sent: whole numbers in as few bytes as they need. What is written list by list is read list by list.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"

namespace mortise {

/// Appends lists to one message.
class PackedWriter {
 public:
  /// Each number by its distance from the least one, in 0 (all are the same), 1, 2, 4 or 8 bytes.
  void integers(std::span<const Global> list);
  void numbers(std::span<const double> list);

  /// The message; leaves an empty one.
  std::vector<char> take() { return std::exchange(bytes_, {}); }

 private:
  void append(const void* data, std::size_t bytes);

  std::vector<char> bytes_;
};

/// Reads the lists in the order in which they were written, from one message or several that stand one behind the other. Refers
/// to the message. Throws std::out_of_range where a list is longer than the message.
class PackedReader {
 public:
  explicit PackedReader(std::span<const char> message) : rest_(message) {}

  bool at_end() const { return rest_.empty(); }
  std::vector<Global> integers();
  std::vector<double> numbers();

 private:
  std::span<const char> take(std::size_t bytes);

  std::span<const char> rest_;
};

}  // namespace mortise
