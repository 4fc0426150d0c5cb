// A library of its own, linked to gmsh's: what the program loads to have gmsh.
#include "gmsh_library.hpp"

extern "C" const mortise::mesh::GmshLibrary* mortise_gmsh_library()
{
  static const mortise::mesh::GmshLibrary library;
  return &library;
}
