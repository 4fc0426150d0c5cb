// Files that a test writes.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace mortise::mesh::test {

/// The path of a file in a folder of this process.
inline std::string path(const std::string& name)
{
  const auto directory = std::filesystem::temp_directory_path() / ("mortise_mesh_test_" + std::to_string(getpid()));
  std::filesystem::create_directories(directory);
  return (directory / name).string();
}

}  // namespace mortise::mesh::test
