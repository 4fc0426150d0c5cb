#include "io/results.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <stdexcept>

#include "base/error.hpp"
#include "io/files.hpp"
#include "vtk_cells.hpp"

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
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

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

// HDF5's file in memory: what the library would have written, in a buffer of ours, which need not reach to the file's end.
using Image = std::vector<char>;

// Has a file that is opened with it stand in `image`, which outlives it, and nowhere else.
void keep_in_memory(hid_t access, Image& image)
{
  constexpr std::size_t growth = 1 << 16;
  require(H5Pset_fapl_core(access, growth, false));
  // All that describes the tables comes before their values, so that the buffer never reaches to these.
  require(H5Pset_meta_block_size(access, growth));
  require(H5Pset_small_data_block_size(access, 0));
  H5FD_file_image_callbacks_t calls{};
  calls.image_realloc = [](void*, std::size_t size, H5FD_file_image_op_t, void* own) -> void* {
    try {
      static_cast<Image*>(own)->resize(size);
      return static_cast<Image*>(own)->data();
    } catch (const std::bad_alloc&) {
      return nullptr;
    }
  };
  calls.image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; };
  calls.udata_copy = [](void* own) { return own; };
  calls.udata_free = [](void*) -> herr_t { return 0; };
  calls.udata = &image;
  require(H5Pset_file_image_callbacks(access, &calls));
}

// A data set whose values have their place in the file, but are not written. Returns that place.
Global lay_out_table(hid_t file, const Table& table)
{
  const hsize_t shape[2] = {static_cast<hsize_t>(table.total), static_cast<hsize_t>(table.columns)};
  const Handle link(H5Pcreate(H5P_LINK_CREATE), H5Pclose), create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(H5Pset_create_intermediate_group(link, 1));
  require(H5Pset_alloc_time(create, H5D_ALLOC_TIME_EARLY));
  require(H5Pset_fill_time(create, H5D_FILL_TIME_NEVER));
  require(H5Pset_obj_track_times(create, false));  // the same results are the same file
  const Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose);
  const Handle dataset(H5Dcreate2(file, table.name.c_str(), H5T_NATIVE_DOUBLE, space, link, create, H5P_DEFAULT), H5Dclose);
  describe(dataset, table.description);
  if (table.total == 0) return 0;
  const haddr_t offset = H5Dget_offset(dataset);
  if (offset == HADDR_UNDEF) throw std::runtime_error(reason());
  return static_cast<Global>(offset);
}

// A file of HDF5 but for the values of its tables.
struct Layout {
  Image image;
  Global size = 0;             // of the whole file
  std::vector<Global> offset;  // where the values of each table begin
};

// HDF5 holds on to layout.image until it returns.
void lay_out(const std::string& path, const std::vector<Table>& tables, Layout& layout)
{
  const Quiet quiet;
  layout.image.reserve(1 << 20);  // if memory is scarce, it shows before HDF5 begins
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  keep_in_memory(access, layout.image);
  const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  for (const auto& table : tables) layout.offset.push_back(lay_out_table(file, table));
  require(H5Fflush(file, H5F_SCOPE_GLOBAL));
  hsize_t size = 0;
  require(H5Fget_filesize(file, &size));
  layout.size = static_cast<Global>(size);
}

// Bytes of the values of the rows before `row`.
Global bytes_before(const Table& table, Global row)
{
  return row * table.columns * static_cast<Global>(sizeof(double));
}

// Makes the file and writes all of it but the values.
void write_layout(const std::string& path, const Layout& layout, const std::vector<Table>& tables)
{
  RawFile file(path, RawFile::Mode::create);
  file.resize(static_cast<std::size_t>(layout.size));
  const auto end = std::min(static_cast<Global>(layout.image.size()), layout.size);
  std::vector<std::pair<Global, Global>> values{{end, end}};  // where they begin and end
  for (std::size_t t = 0; t < tables.size(); ++t)
    values.emplace_back(layout.offset[t], layout.offset[t] + bytes_before(tables[t], tables[t].total));
  std::sort(values.begin(), values.end());
  Global at = 0;
  for (const auto& [first, last] : values) {
    if (at < std::min(first, end))
      file.write(layout.image.data() + at, static_cast<std::size_t>(std::min(first, end) - at), static_cast<std::size_t>(at));
    at = std::max(at, last);
  }
  file.finish();
}

// HDF5 lays the file out in the memory of one rank; what goes to the disk goes there by plain writes, each rank's part of each
// table by its own. So a disk that is full is an error like any other, on the rank that meets it, and HDF5 never sees it.
void write_file(const std::string& path, const std::vector<Table>& tables, const Communicator& comm)
{
  std::vector<Global> offset;
  collectively(comm, [&] {
    if (!comm.root()) return;
    Layout layout;
    lay_out(path, tables, layout);
    write_layout(path, layout, tables);
    offset = std::move(layout.offset);
  });
  comm.broadcast(offset);
  std::optional<RawFile> file;
  collectively(comm, [&] { file.emplace(path, RawFile::Mode::open); });
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const auto values = contiguous(tables[t], comm);
    const Global start = offset[t] + bytes_before(tables[t], part_start(tables[t].total, comm.rank(), comm.size()));
    collectively(comm, [&] { file->write(values.data(), values.size() * sizeof(double), static_cast<std::size_t>(start)); });
  }
  collectively(comm, [&] {
    file->sync();
    file->finish();
  });
}

}  // namespace

std::vector<Table> cell_tables(const std::vector<const mesh::Mesh*>& meshes, Global total, const Communicator& comm)
{
  int widest = 0;
  for (const auto* mesh : meshes)
    for (const auto type : mesh->cells.type) widest = std::max(widest, mesh::node_count(type));
  widest = static_cast<int>(comm.max(static_cast<long long>(widest)));
  Table nodes{"cells/nodes", "numbers of the cell's nodes in VTK's order, -1 after the last", widest, total, {}, {}},
      type{"cells/type", "VTK's number of the cell's shape", 1, total, {}, {}};
  for (const auto* mesh : meshes)
    for (std::size_t c = 0; c < mesh->cells.size(); ++c) {
      const auto own = vtk_nodes(mesh->cells.type[c], mesh->cells[c]);
      for (const auto n : own) nodes.values.push_back(static_cast<double>(mesh->node_id[static_cast<std::size_t>(n)]));
      nodes.values.insert(nodes.values.end(), static_cast<std::size_t>(widest) - own.size(), -1.0);
      type.values.push_back(vtk_type(mesh->cells.type[c]));
      nodes.row.push_back(mesh->cell_id[c]);
      type.row.push_back(mesh->cell_id[c]);
    }
  return {std::move(nodes), std::move(type)};
}

std::vector<double> read_table(const std::string& path, const std::string& name)
{
  try {
    const Quiet quiet;
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(dataset), H5Sclose);
    std::vector<double> values(static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0)));
    if (!values.empty()) require(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    return values;
  } catch (const std::runtime_error& failure) {
    throw Error(ExitStatus::bad_input, fmt::format("{}: {} cannot be read: {}", path, name, failure.what()));
  }
}

void write_results(const std::string& path, const std::vector<Table>& tables, const Communicator& comm)
{
  const std::string temporary = temporary_name(path);
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
