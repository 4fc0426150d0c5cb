// Files that appear under their final names only when they are whole.
#pragma once

#include <functional>
#include <string>

namespace mortise::io {

/// Where the file `path` is written before it gets its name: beside its place.
std::string temporary_name(const std::string& path);

/// Calls write(temporary name) on this rank, has the disk confirm what was written, and renames the file to `path`. Nothing is
/// ever written through what stands at either name, a link least of all: it is replaced. Throws Error(machine), having removed
/// the temporary file, if anything fails. Not collective.
void write_whole(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// Writes a text by write_whole(). Not collective.
void write_text(const std::string& path, const std::string& text);

/// What is in a file; "" if it cannot be read. Not collective.
std::string text_of(const std::string& path);

/// A file open for writing, whose every failure is a std::system_error with the system's reason. Not collective.
class RawFile {
 public:
  enum class Mode {
    create,  ///< anew; whatever has the name is removed first
    open     ///< it is there already
  };
  /// Throws, as all members do.
  RawFile(const std::string& path, Mode mode);
  RawFile(const RawFile&) = delete;
  RawFile& operator=(const RawFile&) = delete;
  ~RawFile();

  /// All `bytes` of `data` from `offset` (bytes) on; the file grows where needed.
  void write(const void* data, std::size_t bytes, std::size_t offset);
  /// The file has so many bytes from now on; new ones are zero.
  void resize(std::size_t bytes);
  /// Waits for the disk, which may only now say that it is full.
  void sync();
  /// Closes the file, which may also fail.
  void finish();

 private:
  int descriptor_;
};

}  // namespace mortise::io
