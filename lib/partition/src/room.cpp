#include "room.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/timer.hpp"

namespace mortise::partition {

namespace {

// Of the subdomains' meshes, at least; what is solved on them takes several times that, and is foreseen once they are there.
constexpr double bytes_a_node = 60, bytes_a_cell = 60;

}  // namespace

void require_room(Global nodes, Global cells, const Communicator& comm)
{
  const double needed = bytes_a_node * static_cast<double>(nodes) + bytes_a_cell * static_cast<double>(cells);
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(comm.mpi(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int neighbours = 1;
  MPI_Comm_size(machine, &neighbours);
  MPI_Comm_free(&machine);
  const double excess = comm.max(needed * neighbours / comm.size() - available_memory());
  if (excess <= 0) return;
  throw Error(
      ExitStatus::machine,
      fmt::format(
          "not enough memory: {:.4g} nodes and {:.4g} cells take about {:.3g} GB by themselves, {:.3g} GB more than there "
          "is; take fewer cells (in the mesh or in mesh.blocks), fewer instances, or more machines",
          static_cast<double>(nodes), static_cast<double>(cells), needed / 1e9, excess / 1e9));
}

}  // namespace mortise::partition
