// Numbers and names in the lines of a text file.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

namespace mortise::io {

inline constexpr double largest_number = 1e50;

/// The parts of a line between `separators`, without what comes after a #.
inline std::vector<std::string> words(const std::string& line, const char* separators = " \t\r,;")
{
  std::vector<std::string> result;
  const std::string text = line.substr(0, line.find('#'));
  for (std::size_t begin = 0; (begin = text.find_first_not_of(separators, begin)) != std::string::npos;) {
    const auto end = std::min(text.find_first_of(separators, begin), text.size());
    result.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return result;
}

inline bool is_number(const std::string& word, double& value)
{
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* end = word.data() + word.size();
  const auto read = std::from_chars(begin, end, value);
  return read.ec == std::errc() && read.ptr == end && std::abs(value) <= largest_number;
}

}  // namespace mortise::io
