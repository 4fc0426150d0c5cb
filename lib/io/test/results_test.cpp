#include "io/results.hpp"

#include <hdf5.h>

#include "base/error.hpp"
#include "scratch.hpp"

namespace mortise::io {
namespace {

using namespace test;

// Row r is (r, r^2, -r); rows are dealt to the ranks like cards, each rank's in falling order.
Table squares(const std::string& name, Global total, const Communicator& comm)
{
  Table table{name, "number, square, opposite", 3, total, {}, {}};
  for (Global r = total - 1; r >= 0; --r) {
    if (r % comm.size() != comm.rank()) continue;
    table.row.push_back(r);
    for (const double x : {static_cast<double>(r), static_cast<double>(r * r), -static_cast<double>(r)})
      table.values.push_back(x);
  }
  return table;
}

struct DataSet {
  std::vector<hsize_t> shape;
  std::vector<double> values;
  std::string description;
};

// Without any of the code under test, and on one rank.
DataSet read(const std::string& path, const std::string& name)
{
  DataSet result;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  result.shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, result.shape.data(), nullptr);
  result.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data()), 0);
  const hid_t attribute = H5Aopen(dataset, "description", H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  result.description.resize(H5Tget_size(type));
  EXPECT_GE(H5Aread(attribute, type, result.description.data()), 0);
  H5Tclose(type), H5Aclose(attribute), H5Sclose(space), H5Dclose(dataset), H5Fclose(file);
  return result;
}

TEST(Results, RowsStandAtTheirNumbersWhoeverHadThem)
{
  const Communicator comm;
  const Scratch scratch(comm);
  // Fewer rows than ranks, and none at all, are tables too.
  write_results(scratch / "results.h5",
                {squares("nodes/squares", 101, comm), squares("one", 1, comm), squares("deep/er/none", 0, comm)}, comm);
  EXPECT_EQ(scratch.files(), std::set<std::string>{"results.h5"});
  if (!comm.root()) return;
  const auto many = read(scratch / "results.h5", "nodes/squares");
  EXPECT_EQ(many.shape, (std::vector<hsize_t>{101, 3}));
  EXPECT_EQ(many.description, "number, square, opposite");
  for (std::size_t r = 0; r < 101; ++r) {
    const auto x = static_cast<double>(r);
    EXPECT_EQ(
        std::vector<double>(many.values.begin() + 3 * static_cast<long>(r), many.values.begin() + 3 * static_cast<long>(r) + 3),
        (std::vector<double>{x, x * x, -x}));
  }
  EXPECT_EQ(read(scratch / "results.h5", "one").values, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(read_table(scratch / "results.h5", "nodes/squares"), many.values);
  EXPECT_TRUE(read_table(scratch / "results.h5", "deep/er/none").empty());
  EXPECT_THROW(read_table(scratch / "results.h5", "nodes/cubes"), Error);
  EXPECT_THROW(read_table(scratch / "none.h5", "one"), Error);
  EXPECT_EQ(read(scratch / "results.h5", "deep/er/none").shape, (std::vector<hsize_t>{0, 3}));
}

// A prism on one rank, a triangle on the last: VTK's wedge has its triangles the other way round.
TEST(Results, CellsStandAtTheirNumbersInTheOrderOfVtk)
{
  const Communicator comm;
  const Scratch scratch(comm);
  mesh::Mesh prism, triangle;
  prism.node_id = {3, 4, 5, 10, 11, 12};
  prism.cells.add(mesh::CellType::prism6, std::vector<Local>{0, 1, 2, 3, 4, 5});
  prism.cell_id = {1};
  triangle.node_id = {4, 7, 9};
  triangle.cells.add(mesh::CellType::tri3, std::vector<Local>{2, 0, 1});
  triangle.cell_id = {0};
  std::vector<const mesh::Mesh*> mine;
  if (comm.root()) mine.push_back(&prism);
  if (comm.rank() == comm.size() - 1) mine.push_back(&triangle);
  write_results(scratch / "results.h5", cell_tables(mine, 2, comm), comm);
  if (!comm.root()) return;
  EXPECT_EQ(read(scratch / "results.h5", "cells/nodes").shape, (std::vector<hsize_t>{2, 6}));
  EXPECT_EQ(read(scratch / "results.h5", "cells/nodes").values, (std::vector<double>{9, 4, 7, -1, -1, -1, 3, 5, 4, 10, 12, 11}));
  EXPECT_EQ(read(scratch / "results.h5", "cells/type").values, (std::vector<double>{5, 13}));
}

TEST(Results, TableWithoutEachRowOnceIsRefused)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const auto write = [&](const Table& table) {
    return message_of_machine_error([&] { write_results(scratch / "results.h5", {squares("good", 10, comm), table}, comm); });
  };
  auto table = squares("squares", 10, comm);
  const bool has_seven = 7 % comm.size() == comm.rank();
  for (auto& row : table.row)
    if (row == 7) row = 6;
  EXPECT_NE(write(table).find("squares: row 6 was given twice"), std::string::npos);
  table = squares("squares", 10, comm);
  if (has_seven)
    for (std::size_t i = 0; i < table.row.size(); ++i)
      if (table.row[i] == 7) {
        table.row.erase(table.row.begin() + static_cast<long>(i));
        table.values.erase(table.values.begin() + 3 * static_cast<long>(i), table.values.begin() + 3 * static_cast<long>(i) + 3);
      }
  EXPECT_NE(write(table).find("squares: nobody has row 7"), std::string::npos);
  table = squares("squares", 10, comm);
  for (auto& row : table.row)
    if (row == 7) row = 10;
  EXPECT_NE(write(table).find("squares: there is no row 10"), std::string::npos);
  EXPECT_EQ(scratch.files(), std::set<std::string>{});
}

// The disk is full for all ranks, or for one of them, which may or may not be one that MPI lets write: no rank hangs, all have
// the same outcome, and the file is whole or not there.
TEST(Results, FullDiskIsAnErrorOnAllRanksAndLeavesNothing)
{
  const Communicator comm;
  const Scratch scratch(comm);
  const auto table = squares("squares", 40000, comm);
  for (int victim = -1; victim < comm.size(); ++victim) {
    std::string message;
    try {
      const FullDisk full(victim < 0 || victim == comm.rank() ? 20000 : RLIM_INFINITY);
      write_results(scratch / "results.h5", {squares("small", 3, comm), table, squares("after", 3, comm)}, comm);
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::machine);
      message = error.what();
      EXPECT_NE(message.find("results.h5: cannot be written: "), std::string::npos) << message;
    }
    const auto failures = comm.sum(static_cast<long long>(!message.empty()));
    EXPECT_TRUE(failures == comm.size() || (failures == 0 && victim >= 0)) << failures << " ranks failed";
    EXPECT_EQ(scratch.files(), failures > 0 ? std::set<std::string>{} : std::set<std::string>{"results.h5"});
    // The next attempt, with space, succeeds.
    write_results(scratch / "results.h5", {table}, comm);
    if (comm.root()) {
      EXPECT_EQ(read(scratch / "results.h5", "squares").values[3 * 39999 + 1], 39999.0 * 39999.0);
      std::filesystem::remove(scratch / "results.h5");
    }
    comm.sum(0LL);
  }
}

TEST(Results, PathBelowAFileIsAnError)
{
  const Communicator comm;
  const Scratch scratch(comm);
  if (comm.root()) std::ofstream(scratch / "file") << "x";
  comm.sum(0LL);
  message_of_machine_error([&] { write_results(scratch / "file/results.h5", {squares("squares", 4, comm)}, comm); });
  EXPECT_EQ(scratch.files(), std::set<std::string>{"file"});
}

}  // namespace
}  // namespace mortise::io
