#include "gmsh_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"

namespace mortise::mesh {

namespace {

// Beside the program, or where it was built.
std::string file_of_library()
{
  const std::filesystem::path built = MORTISE_GMSH_LIBRARY;
  std::error_code none;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", none).parent_path() / built.filename();
  return std::filesystem::exists(beside, none) ? beside.string() : built.string();
}

// gmsh's libraries look for their 100,000 symbols among themselves first. The program's own libraries, as many again, would be
// asked before them, which took two thirds of the time of loading. Where a library was loaded before the program it is to be
// asked first.
int own_symbols_first()
{
#ifdef MORTISE_DEEP_BIND
  if (std::getenv("LD_PRELOAD") == nullptr) return RTLD_DEEPBIND;
#endif
  return 0;
}

}  // namespace

const GmshLibrary& library()
{
  static const GmshLibrary* const loaded = [] {
    const auto file = file_of_library();
    void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | own_symbols_first());
    void* const get = handle == nullptr ? nullptr : dlsym(handle, "mortise_gmsh_library");
    if (get == nullptr) throw Error(ExitStatus::machine, fmt::format("cannot load gmsh's library: {}", dlerror()));
    return reinterpret_cast<GetGmshLibrary*>(get)();
  }();
  return *loaded;
}

}  // namespace mortise::mesh
