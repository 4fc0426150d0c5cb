// gmsh's library around one file: started and stopped, and geometries meshed in a process of their own.
#pragma once

#include <map>
#include <string>

#include "mesh/options.hpp"

namespace mortise::mesh {

/// Throws Error(bad_input) with the name of the file in front.
[[noreturn]] void fail(const std::string& file, const std::string& what);

/// A CAD file (.step, .stp, .brep): geometry without physical groups.
bool is_cad(const std::string& file);
/// An input file of Abaqus or CalculiX, .inp.
bool is_abaqus(const std::string& file);

/// gmsh's library is started and stopped around one file; its constants are command line arguments.
class GmshSession {
 public:
  explicit GmshSession(const std::map<std::string, double>& constants);
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
  ~GmshSession();

  /// Opens the file, and meshes it if it is a geometry. The solids of a CAD file become physical groups.
  /// Returns what went wrong, or "".
  std::string load(const std::string& file, int dimension) const;
  /// Sets gmsh's mesh sizes and the order of cells.
  static void set_sizes(const Options& options);
};

/// The file with the mesh: the one that is given, or a temporary one with the mesh of a geometry, removed in the end. Throws as
/// fail().
class MeshFile {
 public:
  MeshFile(const Options& options, int dimension);
  MeshFile(const MeshFile&) = delete;
  MeshFile& operator=(const MeshFile&) = delete;
  ~MeshFile() { remove(); }
  const std::string& path() const { return path_; }

 private:
  void remove() const;
  std::string path_;
  bool temporary_ = false;
};

}  // namespace mortise::mesh
