// The directory that a run writes to: its own while it runs, and clear of what an earlier run left there.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.hpp"

namespace mortise::io {

/// Locked against other runs while it lives, by a file `mortise.lock` that says who writes there. The system lets go of the lock
/// when the process ends, however it ends.
class OutputDirectory {
 public:
  /// Makes the directory and the ones above it, locks it, and sets the summary of an earlier run aside as summary.old.json, so
  /// that no summary there speaks for this run until it writes its own. `inputs` are the files that the run reads. Throws on all
  /// ranks, having changed nothing: Error(machine) if another run writes there or nothing can be written; Error(bad_input) if
  /// results would replace one of `inputs` or a deck.yaml that no run wrote. Collective.
  OutputDirectory(const std::string& path, const std::vector<std::string>& inputs, const Communicator& comm);
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;
  /// Removes the lock, and the directory if it is still empty and was made here. Not collective.
  ~OutputDirectory();

  /// Removes what an earlier run, on any number of ranks, left under the names that this program writes; other files stay, and so
  /// does what a run that goes on needs, if `resumed`. Throws Error(machine) on all ranks if it cannot. Collective.
  void clear(bool resumed = false) const;

  const std::string& path() const { return path_; }

 private:
  void prepare(const std::vector<std::string>& inputs);
  void release();

  std::string path_;
  Communicator comm_;
  int lock_ = -1;     // root: descriptor of the lock file
  std::string made_;  // root: the uppermost directory that was made, or ""
};

/// For a run that fails before it has an OutputDirectory: sets the summary of an earlier run aside as that does, unless there is
/// none or another run writes there. Never throws. Collective.
void set_aside_summary(const std::string& directory, const Communicator& comm);

/// The first line of every deck.yaml that a run writes: it tells one from a deck of the user's.
std::string written_mark();

}  // namespace mortise::io
