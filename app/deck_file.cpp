#include "deck_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "io/output_directory.hpp"

namespace mortise {

namespace {

constexpr std::size_t longest_deck = 50000000;  // bytes

}  // namespace

std::string read_text(const std::string& file, const Communicator& comm)
{
  std::string text;
  collectively(comm, [&] {
    if (!comm.root()) return;
    if (std::filesystem::is_directory(file)) throw Error(ExitStatus::bad_input, file + ": is a directory; expected a deck");
    std::ifstream stream(file);
    if (!stream) throw Error(ExitStatus::bad_input, file + ": cannot be read: " + std::strerror(errno));
    for (std::array<char, 4096> part; stream && text.size() <= longest_deck;) {
      stream.read(part.data(), part.size());
      text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (text.size() > longest_deck)
      throw Error(ExitStatus::bad_input, fmt::format("{}: is longer than {} MB, which no deck is; expected a text of some pages "
                                                     "(meshes are named in it, by mesh.file)",
                                                     file, longest_deck / 1000000));
  });
  comm.broadcast(text);
  return text;
}

model::Deck read_deck(deck::Document& document, const CommandLine& command_line, const Communicator& comm)
{
  auto deck = model::read_deck(document, command_line.output);
  deck.mesh.allow_scripts = command_line.allow_scripts;
  try {
    collectively(comm, [&] {
      if (const auto& mesh = deck.mesh.file; comm.root() && !mesh.empty() && !std::filesystem::exists(mesh))
        document.error("mesh.file", mesh + ": there is no such file");
      document.check();
    });
  } catch (const Error&) {
    if (!command_line.check) io::set_aside_summary(deck.output.directory, comm);
    throw;
  }
  return deck;
}

}  // namespace mortise
