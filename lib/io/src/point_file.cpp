#include "io/point_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "words.hpp"

namespace mortise::io {

namespace {

constexpr std::size_t longest_line = 1000;

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
