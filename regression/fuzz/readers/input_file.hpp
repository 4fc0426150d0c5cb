// What libFuzzer tries, given to a reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.hpp"

namespace mortise {

/// Runs a reader: it may refuse what it is given as bad input, with a text that says why. Whatever else it throws ends the
/// program.
template <class Read>
void may_refuse(const Read& read)
{
  try {
    read();
  } catch (const Error& error) {
    if (error.status() != ExitStatus::bad_input || std::string(error.what()).empty()) throw;
  }
}

/// Those bytes in a file of this process, which every call writes anew.
inline std::string file_of(const std::string& ending, const std::uint8_t* data, std::size_t size)
{
  static const auto folder = [] {
    std::string name = (std::filesystem::temp_directory_path() / "mortise_reader_XXXXXX").string();
    return std::filesystem::path(mkdtemp(name.data()));
  }();
  const auto file = folder / ("input" + ending);
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

}  // namespace mortise
