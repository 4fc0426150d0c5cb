#include "io/point_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"

namespace mortise::io {

namespace {

constexpr double largest_coordinate = 1e50;
constexpr std::size_t longest_line = 1000;

// The words of a line, without what comes after a #.
std::vector<std::string> words(const std::string& line)
{
  std::vector<std::string> result;
  const std::string text = line.substr(0, line.find('#'));
  for (std::size_t begin = 0; (begin = text.find_first_not_of(" \t\r,;", begin)) != std::string::npos;) {
    const auto end = std::min(text.find_first_of(" \t\r,;", begin), text.size());
    result.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return result;
}

bool is_number(const std::string& word, double& value)
{
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* end = word.data() + word.size();
  const auto read = std::from_chars(begin, end, value);
  return read.ec == std::errc() && read.ptr == end && std::abs(value) <= largest_coordinate;
}

std::vector<ListedPoint> read(const std::string& path, int dimension)
{
  std::ifstream stream(path);
  if (!stream || std::filesystem::is_directory(path))
    throw Error(ExitStatus::bad_input, fmt::format("{} cannot be read{}; expected a file with a point a line", path,
                                                   stream ? "" : std::string(": ") + std::strerror(errno)));
  std::vector<ListedPoint> result;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const auto parts = words(line);
    if (parts.empty()) continue;
    Point at = Point::Zero();
    double first = 0;
    if (result.empty() && number == 1 && !is_number(parts[0], first)) continue;
    bool fits = (parts.size() == 3 || static_cast<int>(parts.size()) == dimension) && line.size() < longest_line;
    for (std::size_t c = 0; fits && c < parts.size(); ++c) fits = is_number(parts[c], at[static_cast<Eigen::Index>(c)]);
    if (!fits || (dimension == 2 && at[2] != 0))
      throw Error(ExitStatus::bad_input,
                  fmt::format("{}:{}: expected {}, found \"{}\"", path, number,
                              dimension == 3 ? "three numbers, x, y, z" : "two numbers, x and y", line.substr(0, 60)));
    result.push_back({at, number});
  }
  if (result.empty()) throw Error(ExitStatus::bad_input, path + ": holds no points; expected one a line");
  return result;
}

}  // namespace

std::vector<ListedPoint> read_points(const std::string& path, int dimension, const Communicator& comm)
{
  std::vector<ListedPoint> result;
  collectively(comm, [&] {
    if (comm.root()) result = read(path, dimension);
  });
  struct Sent {
    double x, y, z;
    int line;
  };
  std::vector<Sent> sent;
  for (const auto& [at, line] : result) sent.push_back({at[0], at[1], at[2], line});
  comm.broadcast(sent);
  result.clear();
  for (const auto& [x, y, z, line] : sent) result.push_back({{x, y, z}, line});
  return result;
}

}  // namespace mortise::io
