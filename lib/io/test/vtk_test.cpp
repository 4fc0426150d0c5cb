#include "io/vtk.hpp"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiPieceDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <map>
#include <regex>

#include "mesh/shape_functions.hpp"
#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;
using mesh::CellType;

constexpr int types = static_cast<int>(mesh::cell_types);

std::vector<Point> reference_nodes(CellType type)
{
  const auto& nodes = mesh::shape_functions(type).nodes();
  return {nodes.begin(), nodes.end()};
}

double pressure_at(const Point& x)
{
  return 0.1 * x[0] + 7 * x[1] - x[2];
}

// Cell i, of the type i modulo their number, stands at x = 3 i; rank r has the cells 8 r .. 8 r + 7, and the last of several
// ranks has none.
Piece row_of_cells(const Communicator& comm)
{
  Piece piece;
  Field pressure{"pressure", 1, {}}, position{"position", 3, {}}, number{"number", 1, {}, true};
  const bool empty = comm.size() > 1 && comm.rank() == comm.size() - 1;
  for (int i = 8 * comm.rank(); !empty && i < 8 * comm.rank() + 8; ++i) {
    const auto type = static_cast<CellType>(i % types);
    std::vector<Local> nodes;
    for (const auto& corner : reference_nodes(type)) {
      nodes.push_back(static_cast<Local>(piece.points.size()));
      piece.points.push_back(corner + Point(3 * i, 0, 0));
      pressure.values.push_back(pressure_at(piece.points.back()));
      for (int c = 0; c < 3; ++c) position.values.push_back(piece.points.back()[c]);
    }
    piece.cells.add(type, nodes);
    number.values.push_back(i);
  }
  piece.point_fields = {pressure, position};
  piece.cell_fields = {number};
  return piece;
}

// What ParaView opens when the user clicks on the .pvd.
vtkSmartPointer<vtkUnstructuredGrid> open(const std::string& directory, const std::string& name)
{
  std::smatch match;
  const auto text = content(directory + "/" + name + ".pvd");
  EXPECT_TRUE(std::regex_search(text, match, std::regex("file=\"([^\"]+)\"")));
  const auto file = directory + "/" + match[1].str();
  const auto read = [&](auto* reader) {
    EXPECT_TRUE(reader->CanReadFile(file.c_str()));
    reader->SetFileName(file.c_str());
    reader->Update();
    return vtkSmartPointer<vtkUnstructuredGrid>(reader->GetOutput());
  };
  if (file.ends_with(".pvtu")) return read(vtkNew<vtkXMLPUnstructuredGridReader>().Get());
  return read(vtkNew<vtkXMLUnstructuredGridReader>().Get());
}

// Newell's area vector, and the centre.
std::pair<Point, Point> area_and_centre(vtkCell* cell)
{
  Point area = Point::Zero(), centre = Point::Zero();
  const auto n = cell->GetNumberOfPoints();
  const auto at = [&](vtkIdType i) { return Point(cell->GetPoints()->GetPoint(i % n)); };
  for (vtkIdType i = 0; i < n; ++i) {
    area += 0.5 * at(i).cross(at(i + 1));
    centre += at(i) / static_cast<double>(n);
  }
  return {area, centre};
}

TEST(Vtk, EveryRanksCellsComeBackWithTheirFields)
{
  const Communicator comm;
  const Scratch scratch(comm);
  write_vtk(scratch.path(), "solution", row_of_cells(comm), comm);
  std::set<std::string> expected{"solution.pvd"};
  for (int r = 0; r < comm.size(); ++r) expected.insert("solution_" + std::to_string(r) + ".vtu");
  if (comm.size() > 1) expected.insert("solution.pvtu");
  EXPECT_EQ(scratch.files(), expected);
  if (!comm.root()) return;

  const auto grid = open(scratch.path(), "solution");
  const int cells = comm.size() > 1 ? 8 * (comm.size() - 1) : 8;
  ASSERT_EQ(grid->GetNumberOfCells(), cells);
  auto* number = grid->GetCellData()->GetArray("number");
  auto* pressure = grid->GetPointData()->GetArray("pressure");
  auto* position = grid->GetPointData()->GetArray("position");
  ASSERT_TRUE(number && pressure && position);
  EXPECT_EQ(number->GetDataType(), VTK_INT);
  EXPECT_EQ(position->GetNumberOfComponents(), 3);
  std::set<int> seen;
  for (vtkIdType c = 0; c < cells; ++c) {
    const auto i = static_cast<int>(number->GetTuple1(c));
    seen.insert(i);
    const auto reference = reference_nodes(static_cast<CellType>(i % types));
    auto* cell = grid->GetCell(c);
    ASSERT_EQ(cell->GetNumberOfPoints(), static_cast<vtkIdType>(reference.size()));
    double lowest = 1;
    for (const auto& x : reference) lowest = std::min(lowest, x[0]);
    EXPECT_NEAR(cell->GetBounds()[0], 3 * i + lowest, 1e-12);
    for (vtkIdType n = 0; n < cell->GetNumberOfPoints(); ++n) {
      const Point x(cell->GetPoints()->GetPoint(n));
      EXPECT_EQ(pressure->GetTuple1(cell->GetPointId(n)), pressure_at(x));
      EXPECT_EQ(Point(position->GetTuple3(cell->GetPointId(n))), x);
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), cells);
}

// Every rank has cells of "all", the first alone those of "first <one>".
TEST(Vtk, BlocksHaveTheirNames)
{
  const Communicator comm;
  const Scratch scratch(comm);
  auto piece = row_of_cells(comm);
  piece.words = {{"words", {"a", "b c"}}};
  std::vector<std::size_t> some;
  for (std::size_t c = 0; c < piece.cells.size(); c += 2) some.push_back(c);
  std::vector<Block> blocks{{"bodies", "all", piece},
                            {"bodies", "first <one>", comm.root() ? part_of(piece, some) : Piece{}},
                            {"contacts", "none", Piece{}}};
  Series series{"blocks", {}};
  write_blocks(scratch.path(), series, {}, blocks, comm);
  write_blocks(scratch.path(), series, 2.0, blocks, comm);
  if (!comm.root()) return;
  EXPECT_NE(content(scratch / "blocks.pvd").find("timestep=\"2\" part=\"0\" file=\"blocks.2.vtm\""), std::string::npos);
  const vtkNew<vtkXMLMultiBlockDataReader> reader;
  reader->SetFileName((scratch / "blocks.2.vtm").c_str());
  reader->Update();
  auto* whole = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  ASSERT_TRUE(whole && whole->GetNumberOfBlocks() == 2);
  const auto name = [](vtkMultiBlockDataSet* of, unsigned i) {
    return std::string(of->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()));
  };
  EXPECT_EQ(name(whole, 0), "bodies");
  auto* bodies = vtkMultiBlockDataSet::SafeDownCast(whole->GetBlock(0));
  ASSERT_TRUE(bodies && bodies->GetNumberOfBlocks() == 2);
  EXPECT_EQ(name(bodies, 1), "first <one>");
  auto* first = vtkMultiPieceDataSet::SafeDownCast(bodies->GetBlock(1));
  ASSERT_TRUE(first && first->GetNumberOfPieces() == 1);
  auto* grid = vtkUnstructuredGrid::SafeDownCast(first->GetPieceAsDataObject(0));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->GetNumberOfCells(), 4);
  auto* words = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("words"));
  ASSERT_TRUE(words && words->GetNumberOfValues() == 2);
  EXPECT_EQ(words->GetValue(1), "b c");
  auto* number = grid->GetCellData()->GetArray("number");
  auto* pressure = grid->GetPointData()->GetArray("pressure");
  for (vtkIdType c = 0; c < 4; ++c) {
    EXPECT_EQ(number->GetTuple1(c), 2.0 * static_cast<double>(c));
    auto* cell = grid->GetCell(c);
    for (vtkIdType n = 0; n < cell->GetNumberOfPoints(); ++n)
      EXPECT_EQ(pressure->GetTuple1(cell->GetPointId(n)), pressure_at(Point(cell->GetPoints()->GetPoint(n))));
  }
}

// VTK orders the nodes of a wedge otherwise than gmsh: a cell is right if VTK finds all its faces looking outwards.
TEST(Vtk, FacesOfSolidsLookOutwards)
{
  const Communicator comm;
  const Scratch scratch(comm);
  Piece piece;
  for (const auto type : {CellType::tet4, CellType::hex8, CellType::prism6}) {
    std::vector<Local> nodes;
    for (const auto& corner : reference_nodes(type)) {
      nodes.push_back(static_cast<Local>(piece.points.size()));
      piece.points.push_back(corner);
    }
    piece.cells.add(type, nodes);
  }
  write_vtk(scratch.path(), "solution", piece, comm);
  if (!comm.root()) return;
  const auto grid = open(scratch.path(), "solution");
  for (vtkIdType c = 0; c < 3; ++c) {
    auto* cell = grid->GetCell(c);
    const Point centre = area_and_centre(cell).second;
    EXPECT_EQ(cell->GetNumberOfFaces(), c == 0 ? 4 : c == 1 ? 6 : 5);
    Point sum = Point::Zero();
    for (int f = 0; f < cell->GetNumberOfFaces(); ++f) {
      const auto [area, middle] = area_and_centre(cell->GetFace(f));
      EXPECT_GT(area.dot(middle - centre), 0) << "cell " << c << " face " << f;
      sum += area;
    }
    EXPECT_LT(sum.norm(), 1e-14);
  }
}

// The cells are affine images of VTK's: each node must lie where its coordinates in VTK's reference cell say.
TEST(Vtk, NodesOfSecondOrderStandWhereVtkExpectsThem)
{
  const Communicator comm;
  const Scratch scratch(comm);
  Piece piece;
  for (int t = 0; t < types; ++t) {
    std::vector<Local> nodes;
    for (const auto& x : reference_nodes(static_cast<CellType>(t))) {
      nodes.push_back(static_cast<Local>(piece.points.size()));
      piece.points.push_back(x);
    }
    piece.cells.add(static_cast<CellType>(t), nodes);
  }
  write_vtk(scratch.path(), "solution", piece, comm);
  if (!comm.root()) return;
  const auto grid = open(scratch.path(), "solution");
  for (vtkIdType c = 0; c < types; ++c) {
    auto* cell = grid->GetCell(c);
    const double* at = cell->GetParametricCoords();
    const auto place = [&](vtkIdType n) { return Point(at[3 * n], at[3 * n + 1], at[3 * n + 2]); };
    const auto position = [&](vtkIdType n) { return Point(cell->GetPoints()->GetPoint(n)); };
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (vtkIdType n = 1; n < cell->GetNumberOfPoints(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (place(n) == Point::Unit(axis)) jacobian.col(axis) = position(n) - position(0);
    for (vtkIdType n = 0; n < cell->GetNumberOfPoints(); ++n)
      EXPECT_LT((position(0) + jacobian * place(n) - position(n)).norm(), 1e-12)
          << mesh::name(static_cast<CellType>(c)) << " node " << n;
  }
}

// The last rank's disk is full: all ranks hear of it, and nothing stays that ParaView could open.
TEST(Vtk, FullDiskOnOneRankIsAnErrorOnAll)
{
  const Communicator comm;
  const Scratch scratch(comm);
  Piece piece;
  for (int i = 0; i < 20000; ++i)
    piece.points.emplace_back(std::sin(i), std::sin(2.5 * i), std::sin(7.1 * i));  // does not compress
  for (Local i = 0; i + 1 < 20000; ++i) piece.cells.add(CellType::line2, std::vector<Local>{i, i + 1});
  const auto message = message_of_machine_error([&] {
    const FullDisk full(comm.rank() == comm.size() - 1 ? 20000 : RLIM_INFINITY);
    write_vtk(scratch.path(), "contact", piece, comm);
  });
  EXPECT_NE(message.find("contact_" + std::to_string(comm.size() - 1) + ".vtu: cannot be written"), std::string::npos) << message;
  EXPECT_EQ(scratch.files(), std::set<std::string>{});
}

TEST(Vtk, DirectoryThatIsNotThereIsAnError)
{
  const Communicator comm;
  const Scratch scratch(comm);
  message_of_machine_error([&] { write_vtk(scratch / "missing", "solution", row_of_cells(comm), comm); });
  EXPECT_EQ(scratch.files(), std::set<std::string>{});
}

}  // namespace
}  // namespace mortise::io
