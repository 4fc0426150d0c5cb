#include "io/vtk.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>

#include "base/error.hpp"
#include "io/files.hpp"

namespace mortise::io {

namespace {

int vtk_type(mesh::CellType type)
{
  using enum mesh::CellType;
  switch (type) {
    case line2:
      return VTK_LINE;
    case tri3:
      return VTK_TRIANGLE;
    case quad4:
      return VTK_QUAD;
    case tet4:
      return VTK_TETRA;
    case hex8:
      return VTK_HEXAHEDRON;
    case prism6:
      return VTK_WEDGE;
    case line3:
      return VTK_QUADRATIC_EDGE;
    case tri6:
      return VTK_QUADRATIC_TRIANGLE;
    case quad8:
      return VTK_QUADRATIC_QUAD;
    case quad9:
      return VTK_BIQUADRATIC_QUAD;
    case tet10:
      return VTK_QUADRATIC_TETRA;
    case hex20:
      return VTK_QUADRATIC_HEXAHEDRON;
    case hex27:
      return VTK_TRIQUADRATIC_HEXAHEDRON;
    case prism15:
      return VTK_QUADRATIC_WEDGE;
    case prism18:
      return VTK_BIQUADRATIC_QUADRATIC_WEDGE;
  }
  return VTK_EMPTY_CELL;
}

// The corners, numbered as VTK does, amid which VTK's nodes after the corners lie. A cell takes as many of them as it has nodes.
const std::vector<std::vector<int>>& vtk_middles(mesh::CellType type)
{
  using enum mesh::CellType;
  static const std::vector<std::vector<int>> line{{0, 1}}, triangle{{0, 1}, {1, 2}, {2, 0}},
      quadrilateral{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}}, tetrahedron{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
      hexahedron{{0, 1},
                 {1, 2},
                 {2, 3},
                 {3, 0},
                 {4, 5},
                 {5, 6},
                 {6, 7},
                 {7, 4},
                 {0, 4},
                 {1, 5},
                 {2, 6},
                 {3, 7},
                 {0, 3, 7, 4},
                 {1, 2, 6, 5},
                 {0, 1, 5, 4},
                 {3, 2, 6, 7},
                 {0, 1, 2, 3},
                 {4, 5, 6, 7},
                 {0, 1, 2, 3, 4, 5, 6, 7}},
      wedge{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  switch (mesh::first_order(type)) {
    case line2:
      return line;
    case tri3:
      return triangle;
    case quad4:
      return quadrilateral;
    case tet4:
      return tetrahedron;
    case hex8:
      return hexahedron;
    default:
      return wedge;
  }
}

// The node of the cell that stands at each place of VTK's cell. VTK's wedge has its triangles the other way round.
std::vector<int> order_in_vtk(mesh::CellType type)
{
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  std::vector<int> order(corners);
  std::iota(order.begin(), order.end(), 0);
  if (mesh::first_order(type) == mesh::CellType::prism6) order = {0, 2, 1, 3, 5, 4};
  for (const auto& amid : vtk_middles(type)) {
    if (order.size() == static_cast<std::size_t>(mesh::node_count(type))) break;
    std::vector<int> own;
    for (const int c : amid) own.push_back(order[static_cast<std::size_t>(c)]);
    order.push_back(mesh::node_amid(type, own));
  }
  return order;
}

std::vector<vtkIdType> vtk_nodes(mesh::CellType type, std::span<const Local> nodes)
{
  static const auto orders = [] {
    std::vector<std::vector<int>> all;
    for (std::size_t t = 0; t < mesh::cell_types; ++t) all.push_back(order_in_vtk(static_cast<mesh::CellType>(t)));
    return all;
  }();
  std::vector<vtkIdType> result;
  for (const int n : orders[static_cast<std::size_t>(type)]) result.push_back(nodes[static_cast<std::size_t>(n)]);
  return result;
}

template <class Array>
void add_array(const Field& field, vtkDataSetAttributes* data)
{
  vtkNew<Array> array;
  array->SetName(field.name.c_str());
  array->SetNumberOfComponents(field.components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(field.values.size()) / field.components);
  for (std::size_t i = 0; i < field.values.size(); ++i)
    array->SetValue(static_cast<vtkIdType>(i), static_cast<typename Array::ValueType>(field.values[i]));
  data->AddArray(array);
}

void add_fields(const std::vector<Field>& fields, vtkDataSetAttributes* data)
{
  for (const auto& field : fields) {
    if (field.integer)
      add_array<vtkIntArray>(field, data);
    else
      add_array<vtkDoubleArray>(field, data);
  }
}

// VTK does not look whether the last block of a file reached the disk.
void require_end(const std::string& path)
{
  const std::string end = "</VTKFile>";
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(file.tellg());
  std::string tail(64, ' ');
  file.seekg(std::max<std::streamoff>(size - static_cast<std::streamoff>(tail.size()), 0));
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (tail.find(end) == std::string::npos) throw std::runtime_error("its end is missing: no space is left on the disk");
}

void write_piece(const std::string& path, const Piece& piece)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& p : piece.points) points->InsertNextPoint(p.data());
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  grid->Allocate(static_cast<vtkIdType>(piece.cells.size()));
  for (std::size_t c = 0; c < piece.cells.size(); ++c) {
    const auto nodes = vtk_nodes(piece.cells.type[c], piece.cells[c]);
    grid->InsertNextCell(vtk_type(piece.cells.type[c]), static_cast<vtkIdType>(nodes.size()), nodes.data());
  }
  add_fields(piece.point_fields, grid->GetPointData());
  add_fields(piece.cell_fields, grid->GetCellData());
  write_whole(path, [&](const std::string& temporary) {
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(temporary.c_str());
    writer->SetInputData(grid);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetCompressorTypeToZLib();
    writer->SetCompressionLevel(1);  // of 9: files a little larger, in a third of the time
    // An observer also keeps VTK from printing the message itself.
    std::string message;
    vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(&message);
    observer->SetCallback([](vtkObject*, unsigned long, void* text, void* said) {
      auto& first = *static_cast<std::string*>(text);
      if (said && first.empty()) first = static_cast<const char*>(said);
    });
    writer->AddObserver(vtkCommand::ErrorEvent, observer);
    writer->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
    writer->Write();
    const auto code = writer->GetErrorCode();
    if (code == vtkErrorCode::OutOfDiskSpaceError) throw std::runtime_error("no space is left on the disk");
    if (code != vtkErrorCode::NoError || !message.empty())
      throw std::runtime_error(code > 0 && code < vtkErrorCode::FirstVTKErrorCode
                                   ? std::strerror(static_cast<int>(code))  // the system's own
                                   : fmt::format("VTK's writer failed ({}) {}", code, message));
    require_end(temporary);
  });
}

std::string declare(const std::vector<Field>& fields)
{
  std::string text;
  for (const auto& field : fields)
    text += fmt::format("      <PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n",
                        field.integer ? "Int32" : "Float64", field.name, field.components);
  return text;
}

std::string parallel_file(const std::string& name, const Piece& piece, int ranks)
{
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<PUnstructuredGrid GhostLevel=\"0\">\n";
  text += "    <PPointData>\n" + declare(piece.point_fields) + "    </PPointData>\n    <PCellData>\n" +
          declare(piece.cell_fields) + "    </PCellData>\n";
  text += "    <PPoints>\n      <PDataArray type=\"Float64\" NumberOfComponents=\"3\"/>\n    </PPoints>\n";
  for (int r = 0; r < ranks; ++r) text += fmt::format("    <Piece Source=\"{}_{}.vtu\"/>\n", name, r);
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

std::string collection(const Series& series)
{
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const auto& [time, file] : series.frames)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, file);
  return text + "  </Collection>\n</VTKFile>\n";
}

// The pieces of one frame, and the .pvd file with the frame as its last.
void write_frame(const std::string& directory, const std::string& name, Series& series, double time, const Piece& piece,
                 const Communicator& comm)
{
  const std::string mine = fmt::format("{}/{}_{}.vtu", directory, name, comm.rank());
  const std::string shown = comm.size() > 1 ? name + ".pvtu" : name + "_0.vtu";
  series.frames.emplace_back(time, shown);
  try {
    collectively(comm, [&] { write_piece(mine, piece); });
    collectively(comm, [&] {
      if (!comm.root()) return;
      if (comm.size() > 1) write_text(directory + "/" + shown, parallel_file(name, piece, comm.size()));
      write_text(directory + "/" + series.name + ".pvd", collection(series));
    });
  } catch (const Error&) {  // on all ranks: pieces without their collection are of no use
    std::error_code ignored;
    std::filesystem::remove(mine, ignored);
    if (comm.root()) std::filesystem::remove(directory + "/" + shown, ignored);
    throw;
  }
}

}  // namespace

void write_vtk(const std::string& directory, const std::string& name, const Piece& piece, const Communicator& comm)
{
  Series single{name, {}};
  write_frame(directory, name, single, 0, piece, comm);
}

void write_vtk(const std::string& directory, Series& series, double time, const Piece& piece, const Communicator& comm)
{
  write_frame(directory, fmt::format("{}.{}", series.name, series.frames.size() + 1), series, time, piece, comm);
}

}  // namespace mortise::io
