#include "mesh/options.hpp"

#include "mesh/cell.hpp"

namespace mortise::mesh {

void describe(deck::Description<BlockOptions>& d)
{
  d.help("A box of equal cells; the body NAME gets the boundaries NAME.xmin ... NAME.zmax.");
  d.key("origin", &BlockOptions::origin, "Lowest corner.");
  d.key("size", &BlockOptions::size, "Edge lengths.").required().at_least(0);
  d.key("cells", &BlockOptions::cells, "Grid cells along each edge.").required().at_least(0);
  d.key("element", &BlockOptions::element,
        "hex8, tet4, prism6, of second order hex20, hex27, tet10, prism15, prism18; plane models: quad4, tri3, quad8, quad9, "
        "tri6.")
      .one_of(
          {"hex8", "tet4", "prism6", "quad4", "tri3", "hex20", "hex27", "tet10", "prism15", "prism18", "quad8", "quad9", "tri6"});
  d.check([](const BlockOptions& block, const std::string& path, deck::Document& document) {
    const auto type = cell_type(block.element);
    if (!type) return;
    const bool plane = dimension(*type) == 2;
    for (std::size_t axis = 0; axis < (plane ? 2U : 3U); ++axis)
      if (block.cells[axis] < 1 || !(block.size[axis] > 0))
        document.error(path + (block.cells[axis] < 1 ? ".cells" : ".size"), "expected a positive entry for each axis");
  });
}

void describe(deck::Description<Options>& d)
{
  d.help("Where the mesh comes from: a file that gmsh reads or meshes, or structured blocks.");
  d.key("file", &Options::file, "A .msh file (2.2 or 4.1), or a .geo, .step or .brep file to be meshed; relative to the deck.");
  d.key("constants", &Options::constants, "Values for the DefineConstant names of a .geo file (gmsh's -setnumber).");
  d.key("scale", &Options::scale, "Coordinates are multiplied by this.").positive();
  d.key("blocks", &Options::blocks, "Structured boxes by body name.");
  d.check([](const Options& mesh, const std::string& path, deck::Document& document) {
    if (mesh.file.empty() == mesh.blocks.empty()) document.error(path, "expected either `file` or `blocks`");
    if (mesh.file.empty() && !mesh.constants.empty())
      document.error(path + ".constants", "constants are for a `file` that gmsh meshes");
  });
}

}  // namespace mortise::mesh
