// Loaded before a program (LD_PRELOAD), has requests for $SHORT_MEMORY bytes or more at once fail as where memory is short: on the
// rank $SHORT_MEMORY_RANK, or on all.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

static int is_short(size_t bytes)
{
  static size_t most = 0;
  if (most == 0) {
    const char *limit = getenv("SHORT_MEMORY"), *rank = getenv("SHORT_MEMORY_RANK"), *me = getenv("OMPI_COMM_WORLD_RANK");
    const int here = limit && (!rank || strcmp(rank, me ? me : "0") == 0);
    most = here ? strtoul(limit, NULL, 10) : (size_t)-1;
  }
  return bytes >= most;
}

void* malloc(size_t bytes)
{
  static void* (*next)(size_t) = NULL;
  if (!next) next = dlsym(RTLD_NEXT, "malloc");
  if (!is_short(bytes)) return next(bytes);
  errno = ENOMEM;
  return NULL;
}

void* realloc(void* old, size_t bytes)
{
  static void* (*next)(void*, size_t) = NULL;
  if (!next) next = dlsym(RTLD_NEXT, "realloc");
  if (!is_short(bytes)) return next(old, bytes);
  errno = ENOMEM;
  return NULL;
}

int posix_memalign(void** place, size_t alignment, size_t bytes)
{
  static int (*next)(void**, size_t, size_t) = NULL;
  if (!next) next = dlsym(RTLD_NEXT, "posix_memalign");
  return is_short(bytes) ? ENOMEM : next(place, alignment, bytes);
}

void* aligned_alloc(size_t alignment, size_t bytes)
{
  static void* (*next)(size_t, size_t) = NULL;
  if (!next) next = dlsym(RTLD_NEXT, "aligned_alloc");
  if (!is_short(bytes)) return next(alignment, bytes);
  errno = ENOMEM;
  return NULL;
}
