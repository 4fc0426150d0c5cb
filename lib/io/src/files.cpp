#include "io/files.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>

#include "base/error.hpp"

namespace mortise::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* suffix = ".part";

// What this program writes, under any number of ranks, and what an interrupted run leaves.
const std::regex& our_files()
{
  static const std::regex names(
      R"((solution|contact)(\.\d+)?(_\d+)?\.(vtu|pvtu|pvd)|results(\.\d+)?\.h5|history\.csv|deck\.yaml|summary\.json|.*\.part)");
  return names;
}

void remove_our_files(const std::string& directory)
{
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), our_files())) stale.push_back(entry.path());
  for (const auto& path : stale) fs::remove(path);
}

}  // namespace

void prepare_directory(const std::string& directory, const Communicator& comm)
{
  collectively(comm, [&] {
    if (!comm.root()) return;
    try {
      fs::create_directories(directory);
      if (!fs::is_directory(directory)) throw std::runtime_error("a file is in its place");
      remove_our_files(directory);
      // Better now than after hours of computing.
      const std::string probe = directory + "/probe" + suffix;
      write_text(probe, "x");
      fs::remove(probe);
    } catch (const std::exception& failure) {
      throw Error(ExitStatus::machine, "output directory " + directory + ": cannot be created or written: " + failure.what());
    }
  });
}

void write_whole(const std::string& path, const std::function<void(const std::string&)>& write)
{
  const std::string temporary = path + suffix;
  try {
    write(temporary);
    fs::rename(temporary, path);
  } catch (const std::exception& failure) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw Error(ExitStatus::machine, path + ": cannot be written: " + failure.what());
  }
}

void write_text(const std::string& path, const std::string& text)
{
  write_whole(path, [&](const std::string& temporary) {
    errno = 0;
    std::ofstream stream(temporary, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw std::runtime_error(errno != 0 ? std::strerror(errno) : "the stream failed");
  });
}

}  // namespace mortise::io
