// Files that appear under their final names only when they are whole.
#pragma once

#include <functional>
#include <string>

#include "base/communicator.hpp"

namespace mortise::io {

/// Makes the directory and the ones above it, and removes from it what an earlier run left there under the names that this
/// program writes, on any number of ranks; other files stay. Throws Error(machine) on all ranks if that cannot be done, or if
/// nothing can be written there. Collective.
void prepare_directory(const std::string& directory, const Communicator& comm);

/// Calls write(temporary name) on this rank and renames the file to `path` when that returns. Throws Error(machine), having
/// removed the temporary file, if anything fails. Not collective.
void write_whole(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// write_whole() of a text.
void write_text(const std::string& path, const std::string& text);

}  // namespace mortise::io
