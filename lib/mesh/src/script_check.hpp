// What can be told of a .geo script without running it.
#pragma once

#include <istream>
#include <string>

namespace mortise::mesh {

/// Throws Error(bad_input) if a macro calls itself, directly or through others, outside of any If: gmsh would never come to an
/// end.
void check_script(const std::string& file, std::istream& script);

}  // namespace mortise::mesh
