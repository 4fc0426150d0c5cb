// A mesh as it stands in a file, whatever the format, and the assembly that is made of it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/read.hpp"

namespace mortise::mesh {

/// Cells in the nodes of the file.
struct RawMesh {
  std::vector<Point> points;
  Cells cells;                       ///< of the model's dimension; of bodies that are their surface alone, of one less
  std::vector<std::size_t> tag;      ///< of each cell: its number in the file
  std::vector<int> volume;           ///< of each cell: index into volumes
  std::vector<int> solid;            ///< of each cell; cells of different solids are different bodies; empty: only volumes matter
  std::vector<std::string> volumes;  ///< physical volumes (2D: surfaces)

  struct Boundary {
    std::string name;
    int solid = -1;                           ///< only on cells of this solid; -1: of all
    std::vector<std::array<Local, 4>> faces;  ///< face_key() of their corners
    bool strict = true;                       ///< every face must be one of the surface of a body; else others are left out
  };
  std::vector<Boundary> boundaries;

  struct NodeSet {
    std::string name;
    std::vector<Local> nodes;
    std::vector<double> weights;  ///< see mesh::NodeSet; a node that stands here twice has the sum
  };
  std::vector<NodeSet> node_sets;
  std::vector<std::string> warnings;
};

class Sender;
class Child;

/// Out of a child process, and what came from there.
void send(const RawMesh& raw, Sender& to);
RawMesh receive(Child& from);

/// Throws Error(bad_input) if a number stands for what is not there, a coordinate is no finite number, or the size is out of
/// range. What a library made of a damaged file may be anything.
void check(const RawMesh& raw, const std::string& file);

/// Bricks, wedges and quadrilaterals that name a node several times become the wedges, tetrahedra and triangles that are meant;
/// faces of boundaries follow. Throws Error(bad_input) where no such cell is left.
void resolve_repeated_nodes(RawMesh& raw, const std::string& file, int dimension);

/// The nodes of the same cell, turned inside out.
std::vector<Local> reversed(CellType type, std::span<const Local> nodes);

/// Moves the points into a plane model's plane z = 0. Throws Error(bad_input) if they are not near.
void flatten(const std::string& file, std::vector<Point>& points);

/// The assembly: cells turned right side out, every connected part of a volume (or of the volumes that options.volumes unites) a
/// body with nodes of its own, and so every closed surface with those of its cavities; facets of the boundaries on it. Throws as
/// read().
Assembly assemble(RawMesh raw, const Options& options, int dimension);

/// The mesh in an Abaqus or CalculiX input file.
RawMesh read_abaqus(const Options& options, int dimension);

}  // namespace mortise::mesh
