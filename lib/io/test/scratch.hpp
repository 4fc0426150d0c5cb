// What the tests of io share: a directory of their own and a disk that is full.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/error.hpp"

namespace mortise::io::test {

/// A fresh directory that all ranks share; removed at the end.
class Scratch {
 public:
  explicit Scratch(const Communicator& comm) : comm_(comm)
  {
    if (comm.root()) {
      std::string pattern = (std::filesystem::temp_directory_path() / "mortise_io_XXXXXX").string();
      path_ = mkdtemp(pattern.data());
    }
    comm.broadcast(path_);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch()
  {
    comm_.sum(0LL);  // all ranks are done
    if (comm_.root()) std::filesystem::remove_all(path_);
  }
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

  /// The names in it, once all ranks have written.
  std::set<std::string> files() const
  {
    comm_.sum(0LL);
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) names.insert(entry.path().filename().string());
    comm_.sum(0LL);
    return names;
  }

 private:
  Communicator comm_;
  std::string path_;
};

/// While it lives no file of this process grows beyond `bytes`: writing fails as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes)
  {
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

/// Runs `work` and returns the message of the Error(machine) that it must throw on this rank.
template <class Work>
std::string message_of_machine_error(const Work& work)
{
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::machine);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

/// A file with this text, which all ranks see from then on.
inline void put(const std::string& path, const std::string& text, const Communicator& comm)
{
  if (comm.root()) std::ofstream(path) << text;
  comm.sum(0LL);
}

inline std::string content(const std::string& path)
{
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace mortise::io::test
