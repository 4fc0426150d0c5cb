// What can be told of a .geo script without running it.
#pragma once

#include <istream>
#include <optional>
#include <string>

namespace mortise::mesh {

/// Throws Error(bad_input) if a macro calls itself, directly or through others, outside of any If: gmsh would never come to an
/// end.
void check_script(const std::string& file, std::istream& script);

/// The line where a script gives a name a value, whatever it was set to from outside: the first that is said of it is a plain
/// assignment under no condition, and it stands in no DefineConstant. A DefineNumber is such an assignment, whatever its name for
/// ONELAB. None where that is not sure.
std::optional<int> overwritten_at(const std::string& name, std::istream& script);

}  // namespace mortise::mesh
