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

#include <filesystem>
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
  }
  return VTK_EMPTY_CELL;
}

// VTK's wedge has its triangles the other way round: the same nodes with two of each swapped.
std::vector<vtkIdType> vtk_nodes(mesh::CellType type, std::span<const Local> n)
{
  if (type == mesh::CellType::prism6) return {n[0], n[2], n[1], n[3], n[5], n[4]};
  return {n.begin(), n.end()};
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
      throw std::runtime_error(fmt::format("VTK's writer failed ({}) {}", code, message));
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

std::string collection(const std::string& file)
{
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n"
      "    <DataSet timestep=\"0\" part=\"0\" file=\"{}\"/>\n  </Collection>\n</VTKFile>\n",
      file);
}

}  // namespace

void write_vtk(const std::string& directory, const std::string& name, const Piece& piece, const Communicator& comm)
{
  const std::string mine = fmt::format("{}/{}_{}.vtu", directory, name, comm.rank());
  const std::string shown = comm.size() > 1 ? name + ".pvtu" : name + "_0.vtu";
  try {
    collectively(comm, [&] { write_piece(mine, piece); });
    collectively(comm, [&] {
      if (!comm.root()) return;
      if (comm.size() > 1) write_text(directory + "/" + shown, parallel_file(name, piece, comm.size()));
      write_text(directory + "/" + name + ".pvd", collection(shown));
    });
  } catch (const Error&) {  // on all ranks: pieces without their collection are of no use
    std::error_code ignored;
    std::filesystem::remove(mine, ignored);
    if (comm.root()) std::filesystem::remove(directory + "/" + shown, ignored);
    throw;
  }
}

}  // namespace mortise::io
