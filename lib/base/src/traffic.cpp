#include "base/traffic.hpp"

#include <mpi.h>

#include <algorithm>
#include <numeric>

#include "base/traffic_counted.hpp"

namespace mortise {

namespace {

// The one global of Mortise: MPI's calls have no other place to count in.
Traffic counted;

}  // namespace

Traffic& Traffic::operator+=(const Traffic& other)
{
  messages += other.messages;
  bytes += other.bytes;
  collectives += other.collectives;
  collective_bytes += other.collective_bytes;
  return *this;
}

Traffic& Traffic::operator-=(const Traffic& other)
{
  messages -= other.messages;
  bytes -= other.bytes;
  collectives -= other.collectives;
  collective_bytes -= other.collective_bytes;
  return *this;
}

Traffic traffic()
{
  return counted;
}

bool traffic_is_counted()
{
#ifdef MORTISE_COUNT_TRAFFIC
  return true;
#else
  return false;
#endif
}

}  // namespace mortise

#ifdef MORTISE_COUNT_TRAFFIC

namespace mortise {

namespace {

long long size_of(long long count, MPI_Datatype type)
{
  int size = 0;
  PMPI_Type_size(type, &size);
  return count * size;
}

int ranks(MPI_Comm comm)
{
  int size = 1;
  PMPI_Comm_size(comm, &size);
  return size;
}

bool is_me(int rank, MPI_Comm comm)
{
  int me = 0;
  PMPI_Comm_rank(comm, &me);
  return rank == me;
}

void message(int count, MPI_Datatype type, int to, MPI_Comm comm)
{
  if (to == MPI_PROC_NULL || is_me(to, comm)) return;
  ++counted.messages;
  counted.bytes += size_of(count, type);
}

void collective(long long bytes, MPI_Comm comm)
{
  if (ranks(comm) == 1) return;
  ++counted.collectives;
  counted.collective_bytes += bytes;
}

long long sum(const int* counts, MPI_Comm comm)
{
  return std::accumulate(counts, counts + ranks(comm), 0LL);
}

}  // namespace

}  // namespace mortise

using namespace mortise;

extern "C" {

#define MORTISE_SENDS(mode)                                                                      \
  int MPI_##mode(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm) \
  {                                                                                              \
    message(count, type, to, comm);                                                              \
    return PMPI_##mode(data, count, type, to, tag, comm);                                        \
  }
MORTISE_SENDS(Send)
MORTISE_SENDS(Bsend)
MORTISE_SENDS(Ssend)
MORTISE_SENDS(Rsend)
#undef MORTISE_SENDS

#define MORTISE_SENDS(mode)                                                                                            \
  int MPI_##mode(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request) \
  {                                                                                                                    \
    message(count, type, to, comm);                                                                                    \
    return PMPI_##mode(data, count, type, to, tag, comm, request);                                                     \
  }
MORTISE_SENDS(Isend)
MORTISE_SENDS(Ibsend)
MORTISE_SENDS(Issend)
MORTISE_SENDS(Irsend)
#undef MORTISE_SENDS

int MPI_Sendrecv(const void* out, int out_count, MPI_Datatype out_type, int to, int out_tag, void* in, int in_count,
                 MPI_Datatype in_type, int from, int in_tag, MPI_Comm comm, MPI_Status* status)
{
  message(out_count, out_type, to, comm);
  return PMPI_Sendrecv(out, out_count, out_type, to, out_tag, in, in_count, in_type, from, in_tag, comm, status);
}

int MPI_Sendrecv_replace(void* data, int count, MPI_Datatype type, int to, int out_tag, int from, int in_tag, MPI_Comm comm,
                         MPI_Status* status)
{
  message(count, type, to, comm);
  return PMPI_Sendrecv_replace(data, count, type, to, out_tag, from, in_tag, comm, status);
}

int MPI_Barrier(MPI_Comm comm)
{
  collective(0, comm);
  return PMPI_Barrier(comm);
}

int MPI_Bcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm comm)
{
  collective(size_of(count, type), comm);
  return PMPI_Bcast(data, count, type, root, comm);
}

int MPI_Reduce(const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm)
{
  collective(size_of(count, type), comm);
  return PMPI_Reduce(in, out, count, type, op, root, comm);
}

#define MORTISE_REDUCES(mode)                                                                       \
  int MPI_##mode(const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm) \
  {                                                                                                 \
    collective(size_of(count, type), comm);                                                         \
    return PMPI_##mode(in, out, count, type, op, comm);                                             \
  }
MORTISE_REDUCES(Allreduce)
MORTISE_REDUCES(Scan)
MORTISE_REDUCES(Exscan)
#undef MORTISE_REDUCES

int MPI_Iallreduce(const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm, MPI_Request* request)
{
  collective(size_of(count, type), comm);
  return PMPI_Iallreduce(in, out, count, type, op, comm, request);
}

int MPI_Reduce_scatter(const void* in, void* out, const int* counts, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  collective(size_of(sum(counts, comm), type), comm);
  return PMPI_Reduce_scatter(in, out, counts, type, op, comm);
}

// What is gathered on, or scattered from, one rank: all parts there, one elsewhere.
int MPI_Gather(const void* in, int in_count, MPI_Datatype in_type, void* out, int out_count, MPI_Datatype out_type, int root,
               MPI_Comm comm)
{
  collective(is_me(root, comm) ? ranks(comm) * size_of(out_count, out_type) : size_of(in_count, in_type), comm);
  return PMPI_Gather(in, in_count, in_type, out, out_count, out_type, root, comm);
}

int MPI_Gatherv(const void* in, int in_count, MPI_Datatype in_type, void* out, const int* counts, const int* places,
                MPI_Datatype out_type, int root, MPI_Comm comm)
{
  collective(is_me(root, comm) ? size_of(sum(counts, comm), out_type) : size_of(in_count, in_type), comm);
  return PMPI_Gatherv(in, in_count, in_type, out, counts, places, out_type, root, comm);
}

int MPI_Scatter(const void* in, int in_count, MPI_Datatype in_type, void* out, int out_count, MPI_Datatype out_type, int root,
                MPI_Comm comm)
{
  collective(is_me(root, comm) ? ranks(comm) * size_of(in_count, in_type) : size_of(out_count, out_type), comm);
  return PMPI_Scatter(in, in_count, in_type, out, out_count, out_type, root, comm);
}

int MPI_Scatterv(const void* in, const int* counts, const int* places, MPI_Datatype in_type, void* out, int out_count,
                 MPI_Datatype out_type, int root, MPI_Comm comm)
{
  collective(is_me(root, comm) ? size_of(sum(counts, comm), in_type) : size_of(out_count, out_type), comm);
  return PMPI_Scatterv(in, counts, places, in_type, out, out_count, out_type, root, comm);
}

int MPI_Allgather(const void* in, int in_count, MPI_Datatype in_type, void* out, int out_count, MPI_Datatype out_type,
                  MPI_Comm comm)
{
  collective(ranks(comm) * size_of(out_count, out_type), comm);
  return PMPI_Allgather(in, in_count, in_type, out, out_count, out_type, comm);
}

int MPI_Allgatherv(const void* in, int in_count, MPI_Datatype in_type, void* out, const int* counts, const int* places,
                   MPI_Datatype out_type, MPI_Comm comm)
{
  collective(size_of(sum(counts, comm), out_type), comm);
  return PMPI_Allgatherv(in, in_count, in_type, out, counts, places, out_type, comm);
}

int MPI_Alltoall(const void* in, int in_count, MPI_Datatype in_type, void* out, int out_count, MPI_Datatype out_type,
                 MPI_Comm comm)
{
  collective(ranks(comm) * size_of(out_count, out_type), comm);
  return PMPI_Alltoall(in, in_count, in_type, out, out_count, out_type, comm);
}

int MPI_Alltoallv(const void* in, const int* in_counts, const int* in_places, MPI_Datatype in_type, void* out,
                  const int* out_counts, const int* out_places, MPI_Datatype out_type, MPI_Comm comm)
{
  const long long received = size_of(sum(out_counts, comm), out_type);
  collective(in == MPI_IN_PLACE ? received : std::max(received, size_of(sum(in_counts, comm), in_type)), comm);
  return PMPI_Alltoallv(in, in_counts, in_places, in_type, out, out_counts, out_places, out_type, comm);
}

}  // extern "C"

#endif
