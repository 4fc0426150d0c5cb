#include "io/results.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "base/error.hpp"

namespace mortise::io {

namespace {

// What HDF5 says of its last failure: the innermost message of its stack.
std::string reason()
{
  std::string message;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* entry, void* text) -> herr_t {
        auto& into = *static_cast<std::string*>(text);
        if (into.empty() && entry->desc) into = entry->desc;
        return 0;
      },
      &message);
  return message.empty() ? "HDF5 failed" : message;
}

void require(herr_t status)
{
  if (status < 0) throw std::runtime_error(reason());
}

// An HDF5 identifier that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close)
  {
    if (id_ < 0) throw std::runtime_error(reason());
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle()
  {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  // Leaves it open.
  void release() { id_ = H5I_INVALID_HID; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Keeps HDF5 from printing its error stacks while it lives.
class Quiet {
 public:
  Quiet()
  {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// First row of the part of the table that rank r writes.
Global part_start(Global total, int rank, int ranks)
{
  return total * rank / ranks;
}

// The rank that writes a row.
int writer_of(Global row, Global total, int ranks)
{
  auto r = static_cast<int>(row * ranks / total);
  while (r + 1 < ranks && row >= part_start(total, r + 1, ranks)) ++r;
  while (r > 0 && row < part_start(total, r, ranks)) --r;
  return r;
}

// The values of rows part_start(rank) .. part_start(rank + 1) - 1, from whichever ranks hold them. Collective.
std::vector<double> contiguous(const Table& table, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  const auto width = static_cast<std::size_t>(table.columns);
  std::vector<std::vector<Global>> rows(ranks);
  std::vector<std::vector<double>> values(ranks);
  collectively(comm, [&] {
    if (table.values.size() != table.row.size() * width)
      throw std::logic_error(table.name + ": values and rows differ in number");
    for (std::size_t i = 0; i < table.row.size(); ++i) {
      if (table.row[i] < 0 || table.row[i] >= table.total)
        throw std::logic_error(fmt::format("{}: there is no row {}", table.name, table.row[i]));
      const auto r = static_cast<std::size_t>(writer_of(table.row[i], table.total, comm.size()));
      const double* from = table.values.data() + i * width;
      rows[r].push_back(table.row[i]);
      values[r].insert(values[r].end(), from, from + width);
    }
  });
  const auto rows_in = comm.exchange(rows);
  const auto values_in = comm.exchange(values);
  const Global start = part_start(table.total, comm.rank(), comm.size());
  const auto count = static_cast<std::size_t>(part_start(table.total, comm.rank() + 1, comm.size()) - start);
  std::vector<double> result;
  collectively(comm, [&] {
    result.resize(count * width);
    std::vector<char> times(count, 0);
    for (std::size_t r = 0; r < ranks; ++r)
      for (std::size_t i = 0; i < rows_in[r].size(); ++i) {
        const auto at = static_cast<std::size_t>(rows_in[r][i] - start);
        if (times[at]++ > 0) throw std::logic_error(fmt::format("{}: row {} was given twice", table.name, rows_in[r][i]));
        std::copy_n(values_in[r].data() + i * width, width, result.data() + at * width);
      }
    for (std::size_t i = 0; i < count; ++i)
      if (times[i] == 0) throw std::logic_error(fmt::format("{}: nobody has row {}", table.name, start + static_cast<Global>(i)));
  });
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

void write_table(hid_t file, const Table& table, const std::vector<double>& values, const Communicator& comm)
{
  const hsize_t shape[2] = {static_cast<hsize_t>(table.total), static_cast<hsize_t>(table.columns)};
  const hsize_t start[2] = {static_cast<hsize_t>(part_start(table.total, comm.rank(), comm.size())), 0};
  const hsize_t count[2] = {values.size() / static_cast<std::size_t>(table.columns), shape[1]};
  const Handle create(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  require(H5Pset_create_intermediate_group(create, 1));
  const Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose);
  const Handle dataset(H5Dcreate2(file, table.name.c_str(), H5T_NATIVE_DOUBLE, space, create, H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose);
  describe(dataset, table.description);
  const Handle memory(H5Screate_simple(2, count, nullptr), H5Sclose);
  if (table.total == 0) return;
  if (count[0] > 0) {
    require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr));
  } else {
    require(H5Sselect_none(space));
    require(H5Sselect_none(memory));
  }
  // Each rank writes one contiguous part, so there is nothing to gain from MPI's collective buffering, in which moreover the
  // other ranks wait for ever if the disk of the one that writes is full.
  const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  require(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_INDEPENDENT));
  require(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, transfer, values.data()));
}

// HDF5's calls communicate inside collectively(), which is sound as long as each of them returns on every rank, in failure too;
// what must not happen is that one rank leaves and the others go on to the next call.
void write_file(const std::string& path, const std::vector<Table>& tables, const Communicator& comm)
{
  const Quiet quiet;
  std::optional<Handle> file;
  collectively(comm, [&] {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    require(H5Pset_fapl_mpio(access, comm.mpi(), MPI_INFO_NULL));
    file.emplace(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  });
  try {
    for (const auto& table : tables) {
      const auto values = contiguous(table, comm);
      collectively(comm, [&] { write_table(*file, table, values, comm); });
    }
    collectively(comm, [&] { require(H5Fflush(*file, H5F_SCOPE_GLOBAL)); });
  } catch (const Error&) {  // on all ranks
    // A file that HDF5 cannot flush, it cannot close either: it would leave a ruin behind, on which it ends by signal in
    // MPI_Finalize.
    if (comm.any(H5Fflush(*file, H5F_SCOPE_GLOBAL) < 0)) file->release();
    throw;
  }
}

}  // namespace

void write_results(const std::string& path, const std::vector<Table>& tables, const Communicator& comm)
{
  const std::string temporary = path + ".part";
  try {
    write_file(temporary, tables, comm);
    collectively(comm, [&] {
      if (comm.root()) std::filesystem::rename(temporary, path);
    });
  } catch (const Error& failure) {  // on all ranks
    std::error_code ignored;
    if (comm.root()) std::filesystem::remove(temporary, ignored);
    throw Error(ExitStatus::machine, path + ": cannot be written: " + failure.what());
  }
}

}  // namespace mortise::io
