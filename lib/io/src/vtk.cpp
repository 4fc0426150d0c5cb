#include "io/vtk.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <filesystem>
#include <type_traits>

#include "base/error.hpp"
#include "io/files.hpp"
#include "vtk_cells.hpp"

namespace mortise::io {

namespace {

template <class Array>
void add_array(const Field& field, vtkDataSetAttributes* data)
{
  vtkNew<Array> array;
  array->SetName(field.name.c_str());
  array->SetNumberOfComponents(field.components);
  if constexpr (std::is_same_v<typename Array::ValueType, double>) {  // read where they are; VTK does not change them
    array->SetArray(const_cast<double*>(field.values.data()), static_cast<vtkIdType>(field.values.size()), 1);
    data->AddArray(array);
    return;
  }
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
  static_assert(sizeof(Point) == 3 * sizeof(double));
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  if (!piece.points.empty())
    coordinates->SetArray(const_cast<double*>(piece.points.front().data()), 3 * static_cast<vtkIdType>(piece.points.size()), 1);
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  grid->Allocate(static_cast<vtkIdType>(piece.cells.size()));
  for (std::size_t c = 0; c < piece.cells.size(); ++c) {
    const auto nodes = vtk_nodes(piece.cells.type[c], piece.cells[c]);
    grid->InsertNextCell(vtk_type(piece.cells.type[c]), static_cast<vtkIdType>(nodes.size()), nodes.data());
  }
  add_fields(piece.point_fields, grid->GetPointData());
  add_fields(piece.cell_fields, grid->GetCellData());
  for (const auto& [name, entries] : piece.words) {
    vtkNew<vtkStringArray> array;
    array->SetName(name.c_str());
    for (const auto& entry : entries) array->InsertNextValue(entry);
    grid->GetFieldData()->AddArray(array);
  }
  // Into memory, and then onto the disk: on a full one VTK's writer frees what it never had.
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->WriteToOutputStringOn();
  writer->SetInputData(grid);
  writer->SetDataModeToBinary();  // base64 in its place: what is appended VTK cannot read with expat 2.6, or 2.5 as Debian mended
                                  // it
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
  if (const auto code = writer->GetErrorCode(); code != vtkErrorCode::NoError || !message.empty())
    throw Error(ExitStatus::machine, fmt::format("{}: VTK's writer failed ({}) {}", path, code, message));
  write_text(path, writer->GetOutputString());
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

std::string escaped(const std::string& text)
{
  std::string result;
  for (const char c : text)
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

// `holds`: for each rank and block whether it has a file.
std::string multiblock_file(const std::string& name, const std::vector<Block>& blocks, const std::vector<char>& holds)
{
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\">\n  "
      "<vtkMultiBlockDataSet>\n";
  int group = -1, entry = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (b == 0 || blocks[b].group != blocks[b - 1].group) {
      if (b > 0) text += "    </Block>\n";
      text += fmt::format("    <Block index=\"{}\" name=\"{}\">\n", ++group, escaped(blocks[b].group));
      entry = 0;
    }
    text += fmt::format("      <Piece index=\"{}\" name=\"{}\">\n", entry++, escaped(blocks[b].name));
    int part = 0;
    for (std::size_t rank = 0; rank * blocks.size() < holds.size(); ++rank)
      if (holds[rank * blocks.size() + b])
        text += fmt::format("        <DataSet index=\"{}\" file=\"{}.b{}_{}.vtu\"/>\n", part++, name, b, rank);
    text += "      </Piece>\n";
  }
  if (!blocks.empty()) text += "    </Block>\n";
  return text + "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
}

}  // namespace

Piece part_of(const Piece& piece, const std::vector<std::size_t>& cells)
{
  Piece part;
  part.words = piece.words;
  std::vector<Local> number(piece.points.size(), -1);
  std::vector<std::size_t> points;
  for (const std::size_t c : cells) {
    std::vector<Local> nodes;
    for (const Local n : piece.cells[c]) {
      auto& own = number[static_cast<std::size_t>(n)];
      if (own < 0) {
        own = static_cast<Local>(points.size());
        points.push_back(static_cast<std::size_t>(n));
      }
      nodes.push_back(own);
    }
    part.cells.add(piece.cells.type[c], nodes);
  }
  for (const std::size_t n : points) part.points.push_back(piece.points[n]);
  const auto take = [](const std::vector<Field>& fields, const std::vector<std::size_t>& rows) {
    std::vector<Field> result;
    for (const auto& field : fields) {
      const auto width = static_cast<std::size_t>(field.components);
      auto& own = result.emplace_back(Field{field.name, field.components, {}, field.integer});
      for (const std::size_t row : rows)
        own.values.insert(own.values.end(), field.values.begin() + static_cast<std::ptrdiff_t>(row * width),
                          field.values.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
    }
    return result;
  };
  part.point_fields = take(piece.point_fields, points);
  part.cell_fields = take(piece.cell_fields, cells);
  return part;
}

void write_blocks(const std::string& directory, Series& series, std::optional<double> time, const std::vector<Block>& blocks,
                  const Communicator& comm)
{
  const auto name = time ? fmt::format("{}.{}", series.name, series.frames.size() + 1) : series.name;
  const auto own_file = [&](std::size_t b) { return fmt::format("{}/{}.b{}_{}.vtu", directory, name, b, comm.rank()); };
  std::vector<char> mine;
  for (const auto& block : blocks) mine.push_back(block.piece.cells.size() > 0);
  const auto holds = comm.all_gather(mine);
  series.frames.emplace_back(time.value_or(0), name + ".vtm");
  try {
    collectively(comm, [&] {
      for (std::size_t b = 0; b < blocks.size(); ++b)
        if (mine[b]) write_piece(own_file(b), blocks[b].piece);
    });
    collectively(comm, [&] {
      if (!comm.root()) return;
      write_text(fmt::format("{}/{}.vtm", directory, name), multiblock_file(name, blocks, holds));
      write_text(directory + "/" + series.name + ".pvd", collection(series));
    });
  } catch (const Error&) {  // on all ranks: blocks without what groups them are of no use
    std::error_code ignored;
    for (std::size_t b = 0; b < blocks.size(); ++b) std::filesystem::remove(own_file(b), ignored);
    if (comm.root()) std::filesystem::remove(fmt::format("{}/{}.vtm", directory, name), ignored);
    throw;
  }
}

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
