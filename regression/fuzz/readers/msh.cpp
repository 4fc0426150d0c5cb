// What is read of a .msh file and of a .geo script before gmsh gets them.
#include "file_kind.hpp"
#include "input_file.hpp"
#include "msh2_tags.hpp"
#include "script_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  mortise::may_refuse([&] {
    const auto file = mortise::file_of(".msh", data, size);
    mortise::mesh::check_file(file);
    mortise::mesh::require_own_entities(file);
  });
  mortise::may_refuse([&] {
    const auto file = mortise::file_of(".geo", data, size);
    mortise::mesh::check_file(file);
    std::ifstream script(file);
    mortise::mesh::overwritten_at("size", script);
  });
  return 0;
}
