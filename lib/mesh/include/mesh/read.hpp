// Meshes from files: .msh (2.2 and 4.1, text and binary) and .stl through the gmsh library, .geo, .step and .brep meshed by it,
// and .inp of Abaqus and CalculiX by a reader of our own.
#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/options.hpp"

namespace mortise::mesh {

/// A whole assembly on one rank.
struct Assembly {
  Catalogue catalogue;
  Mesh mesh;
  std::vector<std::string> warnings;
};

/// Reads options.file. Physical volumes (2D: surfaces) become bodies, physical surfaces (2D: curves) boundaries; groups without a
/// name get their number as name. Every connected part of a group is a body of its own with nodes of its own. Facets between two
/// bodies stand once for each. Cells turned inside out are turned back. Throws Error(bad_input), which names the file, for files
/// that cannot be read, cells of unknown type (pyramids, above second order), cells without volume, cells in no or two groups,
/// and boundaries that lie on no cell; Error(machine) if memory runs out. Not collective: call it on one rank.
Assembly read(const Options& options, int dimension);

}  // namespace mortise::mesh
