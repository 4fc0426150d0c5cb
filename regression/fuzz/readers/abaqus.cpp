// An Abaqus input file, made into bodies and boundaries: in space, and in a plane.
#include "input_file.hpp"
#include "mesh/read.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  mortise::mesh::Options options;
  options.file = mortise::file_of(".inp", data, size);
  for (const int dimension : {2, 3}) mortise::may_refuse([&] { mortise::mesh::read(options, dimension); });
  return 0;
}
