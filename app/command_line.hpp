// The command line of `mortise`.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mortise {

struct CommandLine {
  std::string deck;                   ///< file
  std::vector<std::string> settings;  ///< key.path=value
  std::string output;                 ///< directory; empty: the deck's
  bool resume = false;                ///< go on after the last state that an earlier run finished
  bool check = false;                 ///< read deck and mesh, say what would be solved, and stop
  bool allow_scripts = false;         ///< a .geo may start programs and write files
  bool schema = false;                ///< print the JSON schema of a deck and stop
};

/// The command line or, without one, a text to print and an exit status: 0 for --help and --version, 1 for mistakes.
struct Parsed {
  std::optional<CommandLine> command_line;
  std::string text;
  int status = 0;
};
Parsed parse_command_line(int argc, const char* const* argv);

}  // namespace mortise
