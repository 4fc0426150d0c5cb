#include "io/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/error.hpp"

namespace mortise::io {

namespace {

namespace fs = std::filesystem;

// Throws the system's reason for its last failure.
[[noreturn]] void fail(const char* what)
{
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

std::string temporary_name(const std::string& path)
{
  return path + ".part";
}

RawFile::RawFile(const std::string& path, Mode mode)
{
  if (mode == Mode::create && unlink(path.c_str()) != 0 && errno != ENOENT) fail("the file in its place cannot be removed");
  const int flags = O_WRONLY | O_CLOEXEC | O_NOFOLLOW | (mode == Mode::create ? O_CREAT | O_EXCL : 0);
  descriptor_ = open(path.c_str(), flags, 0666);
  if (descriptor_ < 0) fail("cannot be opened");
}

RawFile::~RawFile()
{
  if (descriptor_ >= 0) close(descriptor_);
}

void RawFile::write(const void* data, std::size_t bytes, std::size_t offset)
{
  const auto* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = pwrite(descriptor_, from, bytes, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done == 0) errno = ENOSPC;
    if (done <= 0) fail("writing failed");
    from += done, offset += static_cast<std::size_t>(done), bytes -= static_cast<std::size_t>(done);
  }
}

void RawFile::resize(std::size_t bytes)
{
  if (ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) fail("resizing failed");
}

void RawFile::sync()
{
  // EINVAL: what is no file on a disk cannot be waited for.
  if (fsync(descriptor_) != 0 && errno != EINVAL) fail("the disk refused it");
}

void RawFile::finish()
{
  if (close(std::exchange(descriptor_, -1)) != 0) fail("closing failed");
}

void write_whole(const std::string& path, const std::function<void(const std::string&)>& write)
{
  const std::string temporary = temporary_name(path);
  try {
    std::error_code absent;
    fs::remove(temporary, absent);  // it may be a link
    write(temporary);
    RawFile file(temporary, RawFile::Mode::open);
    file.sync();
    file.finish();
    fs::rename(temporary, path);
  } catch (const std::exception& failure) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    const bool memory = dynamic_cast<const std::bad_alloc*>(&failure) != nullptr;
    throw Error(ExitStatus::machine, path + ": cannot be written: " + (memory ? "out of memory" : failure.what()));
  }
}

std::string text_of(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  return text.str();
}

void write_text(const std::string& path, const std::string& text)
{
  write_whole(path, [&](const std::string& temporary) {
    RawFile file(temporary, RawFile::Mode::create);
    file.write(text.data(), text.size(), 0);
    file.finish();
  });
}

}  // namespace mortise::io
