// gmsh's library around one file, in a process of its own.
#pragma once

#include <map>
#include <string>

#include "mesh/options.hpp"
#include "raw_mesh.hpp"

namespace mortise::mesh {

/// Throws Error(bad_input) with the name of the file in front.
[[noreturn]] void fail(const std::string& file, const std::string& what);

/// gmsh's library, started for one file; its constants are command line arguments. Nothing stops it but the end of the process:
/// stopping it would remove a file in the user's home directory.
class GmshSession {
 public:
  explicit GmshSession(const std::map<std::string, double>& constants);
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  /// Opens the file. Throws as fail().
  void open(const std::string& file) const;
  /// Meshes the geometry unless the script has done that. The solids of a CAD file become physical groups. Throws as fail().
  void mesh(const Options& options, int dimension) const;
  /// Sets gmsh's mesh sizes and the order of cells.
  static void set_sizes(const Options& options);
};

/// The mesh in options.file, or that of the geometry there, read and meshed by gmsh in a child process. Throws as read().
RawMesh read_gmsh(const Options& options, int dimension);

/// What gmsh's library holds. Throws as read().
RawMesh take_from_gmsh(const Options& options, int dimension);

}  // namespace mortise::mesh
