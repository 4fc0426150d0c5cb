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

}  // namespace

void prepare_directory(const std::string& directory, const Communicator& comm)
{
  collectively(comm, [&] {
    if (!comm.root()) return;
    std::error_code error;
    fs::create_directories(directory, error);
    if (error || !fs::is_directory(directory))
      throw Error(ExitStatus::machine, "output directory " + directory + ": cannot be created: " + (error ? error.message() : "a file is in its place"));
    static const std::regex ours(R"((solution|contact)(_\d+)?\.(vtu|pvtu|pvd)|results\.h5|history\.csv|deck\.yaml|summary\.json|.*\.part)");
    std::vector<fs::path> stale;
    for (const auto& entry : fs::directory_iterator(directory))
      if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), ours)) stale.push_back(entry.path());
    for (const auto& path : stale) fs::remove(path, error);
  });
}

void write_whole(const std::string& path, const std::function<void(const std::string&)>& write)
{
  const std::string temporary = path + suffix;
  std::error_code error;
  try {
    write(temporary);
    fs::rename(temporary, path);
  } catch (const std::exception& failure) {
    fs::remove(temporary, error);
    throw Error(ExitStatus::machine, path + ": cannot be written: " + failure.what());
  }
}

void write_text(const std::string& path, const std::string& text)
{
  write_whole(path, [&](const std::string& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw std::runtime_error(std::strerror(errno));
  });
}

}  // namespace mortise::io
