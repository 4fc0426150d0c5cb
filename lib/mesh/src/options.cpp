#include "mesh/options.hpp"

#include "deck/cases.hpp"
#include "file_kind.hpp"
#include "mesh/cell.hpp"

namespace mortise::mesh {

void describe(deck::Description<BlockOptions>& d)
{
  d.help("A box of equal cells; the body NAME gets the boundaries NAME.xmin ... NAME.zmax.");
  d.key("origin", &BlockOptions::origin, "Lowest corner.");
  d.key("size", &BlockOptions::size, "Edge lengths.").required().at_least(0);
  constexpr double most = 1e9;  // places are counted in half cells, with 31 bits
  d.key("cells", &BlockOptions::cells, "Grid cells along each edge.").required().at_least(0).below(most);
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

void describe(deck::Description<SizeOptions>& d)
{
  d.help("How large the cells are that gmsh makes of a geometry.");
  d.key("max", &SizeOptions::max, "Longest edges, in the unit of the model (after `scale`); absent: gmsh's choice.").positive();
  d.key("min", &SizeOptions::min, "Shortest edges, where curvature or the geometry asks for finer cells.").positive();
  d.key("curvature", &SizeOptions::curvature, "Cells round a full turn of a curved surface or edge.").above(1);
  d.check([](const SizeOptions& size, const std::string& path, deck::Document& document) {
    if (size.min && size.max && *size.min > *size.max) document.error(path + ".min", "is larger than `max`");
  });
}

void describe(deck::Description<Options>& d)
{
  d.help("Where the mesh comes from: a file that gmsh reads or meshes, or structured blocks.");
  d.key(
      "file", &Options::file,
      "A .msh file (2.2 or 4.1); a .geo, .step or .brep file to be meshed; an .inp file of Abaqus or CalculiX; an .stl file of "
      "closed surfaces for bodies of boundary elements, whose solids are bodies and boundaries; relative to the deck. In .step "
      "and .brep files each solid is a body, by its name there or solid.1, solid.2, ..; its faces are the "
      "boundaries NAME.face.1, NAME.face.2, .. (plane models: surface.1, NAME.edge.1): --check lists them with area and centre. "
      "In .inp files the sets of *SOLID SECTION (without one the ELSETs of cells) are bodies; *SURFACE, *NSET and "
      "ELSETs of faces are boundaries.");
  d.key("constants", &Options::constants, "Values for the DefineConstant names of a .geo file (gmsh's -setnumber).");
  d.key("size", &Options::size, "Size of the cells of a geometry, {max, min, curvature}.").hidden();
  d.key("order", &Options::order, "Order of the cells of a geometry: 1, or 2 for cells with curved sides.").at_least(1).below(3);
  d.key("dimension", &Options::dimension,
        "Dimension of the cells of a geometry: one less than the model's makes surfaces alone, for bodies of boundary elements.")
      .at_least(1)
      .below(4);
  d.key("time_limit", &Options::time_limit, "Seconds after which gmsh is stopped that has not read and meshed the file.")
      .positive()
      .below(1e8)
      .hidden();
  d.key("scale", &Options::scale, "Coordinates are multiplied by this.").positive();
  d.key("blocks", &Options::blocks, "Structured boxes by body name.");
  d.rule(deck::one_given({"file", "blocks"}));
  d.rule(deck::when(deck::given({"blocks"}), deck::none_given({"constants", "size", "order", "dimension"})));
  d.check([](const Options& mesh, const std::string& path, deck::Document& document) {
    if (mesh.file.empty() == mesh.blocks.empty()) document.error(path, "expected either `file` or `blocks`");
    if (mesh.file.empty() && !mesh.constants.empty())
      document.error(path + ".constants", "constants are for a `file` that gmsh meshes");
    if (is_geometry(kind_of(mesh.file))) return;
    if (mesh.size.max || mesh.size.min || mesh.size.curvature)
      document.error(path + ".size", "sizes are for a geometry (.geo, .step, .brep) that gmsh meshes");
    if (mesh.dimension)
      document.error(path + ".dimension", "the dimension is for a geometry (.geo, .step, .brep) that gmsh meshes");
    if (mesh.order) document.error(path + ".order", "the order is for a geometry (.geo, .step, .brep) that gmsh meshes");
  });
}

}  // namespace mortise::mesh
