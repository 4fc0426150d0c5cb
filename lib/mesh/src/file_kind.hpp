// Which reader a file is for, and whether it holds what that reader expects.
#pragma once

#include <string>

namespace mortise::mesh {

/// none: no reader is known for this ending.
enum class FileKind { none, msh, geo, step, brep, stl, abaqus };

/// By the ending of its name, in capitals or not.
FileKind kind_of(const std::string& file);
/// A CAD file (.step, .stp, .brep): geometry without physical groups.
bool is_cad(FileKind kind);
/// What gmsh meshes: a CAD file or a .geo.
bool is_geometry(FileKind kind);
/// For messages: ".msh, ...".
extern const char* const known_endings;

/// gmsh guesses what a file is, and what it does not know it takes for a script: a file that is not what its ending says must not
/// get there. Throws Error(bad_input) that names the file and the cause for files that are not there, no files, not readable,
/// empty, of no known ending, without the head or the end of their format; for scripts with a macro that calls itself for ever.
void check_file(const std::string& file);

}  // namespace mortise::mesh
