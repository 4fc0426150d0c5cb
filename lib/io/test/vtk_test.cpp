#include "io/vtk.hpp"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <map>
#include <regex>

#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;
using mesh::CellType;

// The corners of the reference cell of each type, counter-clockwise, bottom before top.
std::vector<Point> corners(CellType type)
{
  switch (type) {
    case CellType::line2:
      return {{0, 0, 0}, {1, 0, 0}};
    case CellType::tri3:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    case CellType::quad4:
      return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    case CellType::tet4:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case CellType::hex8:
      return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    case CellType::prism6:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  }
  return {};
}

const std::vector<CellType> all_types{CellType::line2, CellType::tri3, CellType::quad4,
                                      CellType::tet4,  CellType::hex8, CellType::prism6};

double pressure_at(const Point& x)
{
  return 0.1 * x[0] + 7 * x[1] - x[2];
}

// Cell i, of the type i modulo 6, stands at x = 2 i; rank r has the cells 4 r .. 4 r + 3, and the last of several ranks has none.
Piece row_of_cells(const Communicator& comm)
{
  Piece piece;
  Field pressure{"pressure", 1, {}}, position{"position", 3, {}}, number{"number", 1, {}, true};
  const bool empty = comm.size() > 1 && comm.rank() == comm.size() - 1;
  for (int i = 4 * comm.rank(); !empty && i < 4 * comm.rank() + 4; ++i) {
    const auto type = all_types[static_cast<std::size_t>(i % 6)];
    std::vector<Local> nodes;
    for (const auto& corner : corners(type)) {
      nodes.push_back(static_cast<Local>(piece.points.size()));
      piece.points.push_back(corner + Point(2 * i, 0, 0));
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
  const int cells = comm.size() > 1 ? 4 * (comm.size() - 1) : 4;
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
    const auto reference = corners(all_types[static_cast<std::size_t>(i % 6)]);
    auto* cell = grid->GetCell(c);
    ASSERT_EQ(cell->GetNumberOfPoints(), static_cast<vtkIdType>(reference.size()));
    EXPECT_NEAR(cell->GetBounds()[0], 2 * i, 1e-12);
    for (vtkIdType n = 0; n < cell->GetNumberOfPoints(); ++n) {
      const Point x(cell->GetPoints()->GetPoint(n));
      EXPECT_EQ(pressure->GetTuple1(cell->GetPointId(n)), pressure_at(x));
      EXPECT_EQ(Point(position->GetTuple3(cell->GetPointId(n))), x);
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), cells);
}

// VTK orders the nodes of a wedge otherwise than gmsh: a cell is right if VTK finds all its faces looking outwards.
TEST(Vtk, FacesOfSolidsLookOutwards)
{
  const Communicator comm;
  const Scratch scratch(comm);
  Piece piece;
  for (const auto type : {CellType::tet4, CellType::hex8, CellType::prism6}) {
    std::vector<Local> nodes;
    for (const auto& corner : corners(type)) {
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
