// Loaded before a program (LD_PRELOAD), has writes to files whose path contains $FULL_DISK fail as on a full disk: on the rank
// $FULL_DISK_RANK, or on all, and once $FULL_DISK_AFTER bytes are written to such files. With $FULL_DISK_LIST all writes succeed, and a
// line "bytes path" for each stands in that file.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

static size_t written = 0;

static void list(const char* name, const char* path, size_t bytes)
{
  const int file = open(name, O_WRONLY | O_CREAT | O_APPEND, 0644);
  if (file < 0) return;
  dprintf(file, "%zu %s\n", bytes, path);  // by a write of the C library's own, which is not the one below
  close(file);
}

static int is_full(int descriptor, size_t bytes)
{
  const char *part = getenv("FULL_DISK"), *rank = getenv("FULL_DISK_RANK"), *me = getenv("OMPI_COMM_WORLD_RANK"),
             *after = getenv("FULL_DISK_AFTER"), *listed = getenv("FULL_DISK_LIST");
  if (!part || (rank && strcmp(rank, me ? me : "0") != 0)) return 0;
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t n = readlink(link, path, sizeof path - 1);
  if (n < 0) return 0;
  path[n] = 0;
  if (!strstr(path, part)) return 0;
  if (listed) {
    list(listed, path, bytes);
    return 0;
  }
  written += bytes;
  if (written <= (after ? strtoul(after, NULL, 10) : 0)) return 0;
  errno = ENOSPC;
  return 1;
}

ssize_t write(int descriptor, const void* data, size_t bytes)
{
  static ssize_t (*next)(int, const void*, size_t) = NULL;
  if (!next) next = dlsym(RTLD_NEXT, "write");
  return is_full(descriptor, bytes) ? -1 : next(descriptor, data, bytes);
}

ssize_t writev(int descriptor, const struct iovec* parts, int count)
{
  static ssize_t (*next)(int, const struct iovec*, int) = NULL;
  if (!next) next = dlsym(RTLD_NEXT, "writev");
  size_t bytes = 0;
  for (int i = 0; i < count; ++i) bytes += parts[i].iov_len;
  return is_full(descriptor, bytes) ? -1 : next(descriptor, parts, count);
}

ssize_t pwrite(int descriptor, const void* data, size_t bytes, off_t offset)
{
  static ssize_t (*next)(int, const void*, size_t, off_t) = NULL;
  if (!next) next = dlsym(RTLD_NEXT, "pwrite");
  return is_full(descriptor, bytes) ? -1 : next(descriptor, data, bytes, offset);
}

ssize_t pwrite64(int descriptor, const void* data, size_t bytes, off_t offset)
{
  return pwrite(descriptor, data, bytes, offset);
}
