#include "io/results.hpp"

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>

#include "base/error.hpp"

namespace mortise::io {

namespace {

// An HDF5 identifier that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close)
  {
    if (id_ < 0) throw std::runtime_error("an HDF5 call failed");
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(herr_t status)
{
  if (status < 0) throw std::runtime_error("an HDF5 call failed (is the disk full?)");
}

// First row of the part of the table that rank r writes.
Global part_start(Global total, int rank, int ranks) { return total * rank / ranks; }

// The values of rows part_start(rank) .. part_start(rank + 1) - 1, from whichever ranks hold them.
std::vector<double> contiguous(const Table& table, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Global>> rows(ranks);
  std::vector<std::vector<double>> values(ranks);
  const auto width = static_cast<std::size_t>(table.columns);
  for (std::size_t i = 0; i < table.row.size(); ++i) {
    auto r = static_cast<std::size_t>(table.row[i] * comm.size() / std::max<Global>(table.total, 1));
    while (r + 1 < ranks && table.row[i] >= part_start(table.total, static_cast<int>(r) + 1, comm.size())) ++r;
    while (r > 0 && table.row[i] < part_start(table.total, static_cast<int>(r), comm.size())) --r;
    rows[r].push_back(table.row[i]);
    values[r].insert(values[r].end(), table.values.begin() + static_cast<std::ptrdiff_t>(i * width), table.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
  }
  const auto rows_in = comm.exchange(rows);
  const auto values_in = comm.exchange(values);
  const Global start = part_start(table.total, comm.rank(), comm.size());
  std::vector<double> result(static_cast<std::size_t>(part_start(table.total, comm.rank() + 1, comm.size()) - start) * width, 0.0);
  for (std::size_t r = 0; r < ranks; ++r)
    for (std::size_t i = 0; i < rows_in[r].size(); ++i)
      std::copy_n(values_in[r].begin() + static_cast<std::ptrdiff_t>(i * width), width, result.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(rows_in[r][i] - start) * width));
  return result;
}

void describe(hid_t dataset, const std::string& text)
{
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)));
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(dataset, "description", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(attribute, type, text.c_str()));
}

void write_table(hid_t file, const Table& table, const Communicator& comm)
{
  const auto values = contiguous(table, comm);
  const hsize_t shape[2] = {static_cast<hsize_t>(table.total), static_cast<hsize_t>(table.columns)};
  const hsize_t start[2] = {static_cast<hsize_t>(part_start(table.total, comm.rank(), comm.size())), 0};
  const hsize_t count[2] = {values.size() / static_cast<std::size_t>(table.columns), shape[1]};
  const Handle create(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  require(H5Pset_create_intermediate_group(create, 1));
  const Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose);
  const Handle dataset(H5Dcreate2(file, table.name.c_str(), H5T_NATIVE_DOUBLE, space, create, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  describe(dataset, table.description);
  const Handle memory(H5Screate_simple(2, count, nullptr), H5Sclose);
  if (count[0] > 0)
    require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr));
  else
    require(H5Sselect_none(space));
  const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  require(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE));
  require(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, transfer, values.data()));
}

}  // namespace

void write_results(const std::string& path, const std::vector<Table>& tables, const Communicator& comm)
{
  const std::string temporary = path + ".part";
  std::string failure;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {  // HDF5's collective calls fail on all ranks together
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    require(H5Pset_fapl_mpio(access, comm.mpi(), MPI_INFO_NULL));
    const Handle file(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
    for (const auto& table : tables) write_table(file, table, comm);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  collectively(comm, [&] {
    std::error_code ignored;
    if (!failure.empty()) {
      if (comm.root()) std::filesystem::remove(temporary, ignored);
      throw Error(ExitStatus::machine, path + ": cannot be written: " + failure);
    }
    if (comm.root()) std::filesystem::rename(temporary, path);
  });
}

}  // namespace mortise::io
