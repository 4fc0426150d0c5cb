#include "io/output_directory.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <system_error>

#include "base/error.hpp"
#include "io/files.hpp"

namespace mortise::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "mortise.lock";
constexpr const char* summary_name = "summary.json";
constexpr const char* old_summary_name = "summary.old.json";

// What this program writes, under any number of ranks, and what it leaves if it is killed while it writes.
bool is_ours(const fs::path& path)
{
  static const std::regex names(
      R"(((solution|contact|plane\.[\w-]+)(\.\d+)?(_\d+)?\.(vtu|pvtu|pvd)|)"
      R"(blocks(\.\d+)?(\.b\d+_\d+\.vtu|\.vtm|\.pvd)|)"
      R"((results|restart)(\.\d+)?\.h5|(history|interior|probes|probe\.[\w-]+)\.csv|deck\.yaml|summary(\.old)?\.json)(\.part)?)");
  return std::regex_match(path.filename().string(), names);
}

// What names other files comes first: a run that is killed while it removes them leaves nothing that opens what is gone.
std::vector<fs::path> our_files(const std::string& directory)
{
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(directory))
    if (is_ours(entry.path())) files.push_back(entry.path());
  const auto depth = [](const fs::path& path) {
    const auto extension = path.extension();
    return extension == ".pvd" ? 0 : extension == ".pvtu" || extension == ".vtm" ? 1 : 2;
  };
  std::ranges::sort(files, {}, [&](const fs::path& path) { return std::pair(depth(path), path); });
  return files;
}

// A deck that the user wrote: it reads like one and has neither the mark of ours nor all the sections that they have.
bool is_deck_of_the_user(const fs::path& path)
{
  std::ifstream stream(path);
  std::ostringstream content;
  content << '\n';
  if (stream.peek() != std::ifstream::traits_type::eof()) content << stream.rdbuf();
  const std::string text = content.str();
  const auto has = [&](const char* section) { return text.find(std::string("\n") + section + ":") != std::string::npos; };
  if (text.starts_with("\n" + written_mark())) return false;
  const bool complete = has("decomposition") && has("solver") && has("friction_loop") && has("output");
  return has("mesh") && has("materials") && !complete;
}

// Refuses what results must not replace.
void protect(const std::string& directory, const std::vector<std::string>& inputs)
{
  for (const auto& path : our_files(directory)) {
    if (fs::is_directory(path))
      throw Error(ExitStatus::machine, path.string() + ": is a directory, where a file of results has to go; remove it");
    for (const auto& input : inputs) {
      std::error_code absent;
      if (fs::equivalent(path, input, absent))
        throw Error(ExitStatus::bad_input, fmt::format("output directory {}: the results would replace {}, which this run reads; "
                                                       "choose another directory (output.directory, --output)",
                                                       directory, input));
    }
    if (path.filename() == "deck.yaml" && is_deck_of_the_user(path))
      throw Error(ExitStatus::bad_input, fmt::format("{}: the results hold a deck.yaml, which would replace this deck of yours; "
                                                     "choose another directory (output.directory, --output)",
                                                     path.string()));
  }
}

std::string whoami()
{
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {} since {:%Y-%m-%d %H:%M:%S}", getpid(), host.data(), fmt::localtime(std::time(nullptr)));
}

// What the lock file says of the run that holds it.
std::string holder(int descriptor)
{
  std::array<char, 512> text{};
  const ssize_t n = pread(descriptor, text.data(), text.size() - 1, 0);
  std::string said(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  said = said.substr(0, said.find('\n'));
  return said.empty() ? "which does not say who it is" : said;
}

// Whether `descriptor` is still the file at `path`: the run before may have removed it while this one waited for the lock.
bool still_there(int descriptor, const std::string& path)
{
  struct stat mine {
  }, there{};
  return fstat(descriptor, &mine) == 0 && stat(path.c_str(), &there) == 0 && mine.st_ino == there.st_ino &&
         mine.st_dev == there.st_dev;
}

// A lock of POSIX: unlike those of flock() no child inherits it, and network file systems know it.
int lock(const std::string& directory)
{
  const std::string path = directory + "/" + lock_name;
  while (true) {
    const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0) throw std::system_error(errno, std::generic_category(), path);
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    const int result = fcntl(descriptor, F_SETLK, &whole);
    if (result < 0 && (errno == EACCES || errno == EAGAIN)) {
      const auto who = holder(descriptor);
      close(descriptor);
      throw Error(ExitStatus::machine, fmt::format("output directory {}: another run writes there, {}; wait for it, end it, or "
                                                   "choose another directory (output.directory, --output)",
                                                   directory, who));
    }
    // Any other failure: a file system without locks, which must not keep anybody from computing.
    if (still_there(descriptor, path)) return descriptor;
    close(descriptor);
  }
}

void write_holder(int descriptor, const std::string& path)
{
  const std::string text = whoami() + "\n";
  if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) ||
      fsync(descriptor) != 0)
    throw std::system_error(errno, std::generic_category(), path);
}

// The uppermost part of `path` that is not there yet; empty if all is.
std::string first_missing(const std::string& path)
{
  fs::path missing;
  for (fs::path p = fs::absolute(path).lexically_normal(); !p.empty() && !fs::exists(p); p = p.parent_path()) {
    missing = p;
    if (p == p.parent_path()) break;
  }
  return missing.string();
}

}  // namespace

std::string written_mark()
{
  return "# Written by Mortise: the deck of this run with every default filled in.";
}

OutputDirectory::OutputDirectory(const std::string& path, const std::vector<std::string>& inputs, const Communicator& comm)
    : path_(path), comm_(comm)
{
  try {
    collectively(comm, [&] {
      if (comm.root()) prepare(inputs);
    });
  } catch (...) {
    release();
    throw;
  }
}

OutputDirectory::~OutputDirectory()
{
  release();
}

void OutputDirectory::prepare(const std::vector<std::string>& inputs)
{
  try {
    made_ = first_missing(path_);
    fs::create_directories(path_);
    if (!fs::is_directory(path_)) throw std::runtime_error("a file is in its place");
    lock_ = lock(path_);
    protect(path_, inputs);
    write_holder(lock_, path_ + "/" + lock_name);  // also tries the disk: better now than after hours of computing
    if (fs::exists(fs::path(path_) / summary_name))
      fs::rename(fs::path(path_) / summary_name, fs::path(path_) / old_summary_name);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& failure) {
    throw Error(ExitStatus::machine, "output directory " + path_ + ": cannot be created or written: " + failure.what());
  }
}

void OutputDirectory::clear(bool resumed) const
{
  collectively(comm_, [&] {
    if (!comm_.root()) return;
    try {
      for (const auto& path : our_files(path_)) {
        const auto name = path.filename().string();
        if (!resumed || !(name.starts_with("restart.") || name == "deck.yaml")) fs::remove(path);
      }
    } catch (const std::exception& failure) {
      throw Error(ExitStatus::machine,
                  "output directory " + path_ + ": results of an earlier run cannot be removed: " + failure.what());
    }
  });
}

void OutputDirectory::release()
{
  if (lock_ >= 0) {
    // Before the lock goes, or it might be that of the next run.
    if (const auto path = path_ + "/" + lock_name; still_there(lock_, path)) unlink(path.c_str());
    close(lock_);
  }
  lock_ = -1;
  if (made_.empty()) return;
  std::error_code not_empty;  // from the inside out
  for (fs::path p = fs::absolute(path_).lexically_normal(); p.string().size() >= made_.size(); p = p.parent_path())
    if (!fs::remove(p, not_empty)) break;
}

void set_aside_summary(const std::string& directory, const Communicator& comm)
{
  try {
    if (comm.any(comm.root() && fs::exists(fs::path(directory) / summary_name))) OutputDirectory(directory, {}, comm);
  } catch (const Error&) {  // on all ranks
  }
}

}  // namespace mortise::io
