#include <gtest/gtest.h>
#include <hdf5.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "io/files.hpp"
#include "io/results.hpp"
#include "io/summary.hpp"
#include "io/vtk.hpp"

namespace mortise::io {
namespace {

namespace fs = std::filesystem;

// A directory of this test program, the same on all ranks.
std::string directory(const Communicator& comm, const std::string& name)
{
  std::string path = (fs::temp_directory_path() / ("mortise_io_test_" + std::to_string(getpid()))).string();
  comm.broadcast(path);
  return path + "/" + name;
}

std::string text_of(const std::string& path)
{
  std::ifstream stream(path);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

TEST(Files, StaleResultsGoAndOthersStay)
{
  const Communicator comm;
  const auto at = directory(comm, "stale");
  prepare_directory(at, comm);
  if (comm.root())
    for (const char* name : {"solution_7.vtu", "summary.json", "x.part", "notes.txt"}) write_text(at + "/" + name, "old");
  prepare_directory(at, comm);
  EXPECT_FALSE(fs::exists(at + "/solution_7.vtu"));
  EXPECT_FALSE(fs::exists(at + "/summary.json"));
  EXPECT_FALSE(fs::exists(at + "/x.part"));
  EXPECT_TRUE(fs::exists(at + "/notes.txt"));
}

TEST(Files, AFileInTheWayIsAnErrorOnAllRanks)
{
  const Communicator comm;
  const auto at = directory(comm, "blocked");
  prepare_directory(at, comm);
  if (comm.root()) write_text(at + "/file", "x");
  try {
    prepare_directory(at + "/file/below", comm);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::machine);
    EXPECT_NE(std::string(error.what()).find("cannot be created"), std::string::npos);
  }
}

TEST(Files, AFailedWriteLeavesNothing)
{
  const Communicator comm;
  const auto at = directory(comm, "failed");
  prepare_directory(at, comm);
  const auto path = at + "/rank" + std::to_string(comm.rank());
  EXPECT_THROW(write_whole(path,
                           [](const std::string& temporary) {
                             std::ofstream(temporary) << "half";
                             throw std::runtime_error("disk full");
                           }),
               Error);
  EXPECT_FALSE(fs::exists(path));
  EXPECT_FALSE(fs::exists(path + ".part"));
}

TEST(Vtk, PiecesReadBack)
{
  const Communicator comm;
  const auto at = directory(comm, "vtk");
  prepare_directory(at, comm);
  Piece piece;
  const double x = comm.rank();
  piece.points = {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}, {x + 1, 0, 1}, {x, 1, 1}};
  piece.cells.add(mesh::CellType::prism6, std::vector<Local>{0, 1, 2, 3, 4, 5});
  piece.point_fields = {{"displacement", 3, std::vector<double>(18, 0.5)}};
  piece.cell_fields = {{"body", 1, {x}, true}};
  write_vtk(at, "solution", piece, comm);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((at + "/solution_" + std::to_string(comm.rank()) + ".vtu").c_str());
  reader->Update();
  auto* grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfPoints(), 6);
  EXPECT_EQ(grid->GetCellType(0), VTK_WEDGE);
  EXPECT_EQ(grid->GetPointData()->GetArray("displacement")->GetNumberOfComponents(), 3);
  EXPECT_EQ(grid->GetCellData()->GetArray("body")->GetTuple1(0), x);
  const auto collection = text_of(at + "/solution.pvd");
  EXPECT_NE(collection.find(comm.size() > 1 ? "solution.pvtu" : "solution_0.vtu"), std::string::npos);
  if (comm.size() > 1) {
    EXPECT_NE(text_of(at + "/solution.pvtu").find("solution_1.vtu"), std::string::npos);
  }
}

TEST(Results, RowsStandWhereTheirNumbersSay)
{
  const Communicator comm;
  const auto at = directory(comm, "hdf5");
  prepare_directory(at, comm);
  Table table{"nodes/values", "twice the number, and its square", 2, 100, {}, {}};
  for (Global row = comm.rank(); row < 100; row += comm.size()) {
    table.row.push_back(row);
    table.values.push_back(2.0 * static_cast<double>(row));
    table.values.push_back(static_cast<double>(row * row));
  }
  write_results(at + "/results.h5", {table}, comm);
  EXPECT_FALSE(fs::exists(at + "/results.h5.part"));
  if (comm.root()) {
    const hid_t file = H5Fopen((at + "/results.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    const hid_t dataset = H5Dopen2(file, "nodes/values", H5P_DEFAULT);
    std::vector<double> values(200);
    ASSERT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    for (int row = 0; row < 100; ++row) {
      EXPECT_EQ(values[static_cast<std::size_t>(2 * row)], 2.0 * row);
      EXPECT_EQ(values[static_cast<std::size_t>(2 * row + 1)], static_cast<double>(row) * row);
    }
    H5Dclose(dataset);
    H5Fclose(file);
  }
  EXPECT_THROW(write_results(at + "/absent/results.h5", {table}, comm), Error);
}

TEST(Summary, KeepsItsPromise)
{
  Summary summary;
  summary.title = "A \"quoted\" title";
  summary.strain_energy = std::nan("");
  summary.contacts.push_back({"interface", {1, 2, 3}, 4, 5, 6, 7, 8});
  summary.time["solve"] = 1.5;
  const auto json = nlohmann::json::parse(to_json(summary));
  for (const char* key : {"version", "title", "converged", "exit_status", "ranks", "primal_unknowns", "dual_unknowns", "subdomains", "kernel_dimension", "bodies", "friction_steps",
                          "outer_iterations", "hessian_multiplications", "residuals", "error_estimate", "strain_energy", "max_von_mises", "max_displacement", "reactions", "contacts",
                          "time", "peak_memory_bytes"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_TRUE(json["strain_energy"].is_null());
  EXPECT_EQ(json["contacts"][0]["slip"], 8);
  EXPECT_EQ(json["time"]["solve"], 1.5);
  EXPECT_EQ(json["time"]["output"], 0.0);
}

}  // namespace
}  // namespace mortise::io
