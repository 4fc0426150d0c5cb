#include "base/communicator.hpp"

#include <algorithm>
#include <numeric>

namespace mortise {
namespace {

// MPI counts are ints: larger messages go in pieces of this many bytes.
constexpr std::size_t piece = std::size_t{1} << 30;

}  // namespace

Communicator::Communicator(MPI_Comm comm) : comm_(comm)
{
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

double Communicator::reduce(double x, MPI_Op op) const
{
  double result = 0;
  MPI_Allreduce(&x, &result, 1, MPI_DOUBLE, op, comm_);
  return result;
}

long long Communicator::reduce(long long x, MPI_Op op) const
{
  long long result = 0;
  MPI_Allreduce(&x, &result, 1, MPI_LONG_LONG, op, comm_);
  return result;
}

void Communicator::sum_in_place(std::span<double> x) const
{
  MPI_Allreduce(MPI_IN_PLACE, x.data(), static_cast<int>(x.size()), MPI_DOUBLE, MPI_SUM, comm_);
}

long long Communicator::offset(long long x) const
{
  long long result = 0;
  MPI_Exscan(&x, &result, 1, MPI_LONG_LONG, MPI_SUM, comm_);
  return rank_ == 0 ? 0 : result;
}

void Communicator::broadcast(std::string& x, int from) const
{
  std::vector<char> data(x.begin(), x.end());
  broadcast(data, from);
  x.assign(data.begin(), data.end());
}

void Communicator::broadcast_bytes(void* data, std::size_t bytes, int from) const
{
  for (std::size_t done = 0; done < bytes; done += piece)
    MPI_Bcast(static_cast<char*>(data) + done, static_cast<int>(std::min(piece, bytes - done)), MPI_BYTE, from, comm_);
}

std::vector<char> Communicator::all_gather_bytes(const void* data, std::size_t bytes) const
{
  const unsigned long long mine = bytes;
  std::vector<unsigned long long> sizes(size_), places(size_);
  MPI_Allgather(&mine, 1, MPI_UNSIGNED_LONG_LONG, sizes.data(), 1, MPI_UNSIGNED_LONG_LONG, comm_);
  std::exclusive_scan(sizes.begin(), sizes.end(), places.begin(), 0ULL);
  std::vector<char> result(places.back() + sizes.back());
  if (result.size() <= piece) {
    const std::vector<int> counts(sizes.begin(), sizes.end()), starts(places.begin(), places.end());
    MPI_Allgatherv(data, counts[rank_], MPI_BYTE, result.data(), counts.data(), starts.data(), MPI_BYTE, comm_);
  } else {
    if (bytes > 0) std::memcpy(result.data() + places[rank_], data, bytes);
    for (int r = 0; r < size_; ++r) broadcast_bytes(result.data() + places[r], sizes[r], r);
  }
  return result;
}

std::vector<std::vector<char>> Communicator::exchange_bytes(const std::vector<std::pair<const void*, std::size_t>>& send) const
{
  std::vector<unsigned long long> outgoing(size_), incoming(size_);
  for (int r = 0; r < size_; ++r) outgoing[r] = send[r].second;
  MPI_Alltoall(outgoing.data(), 1, MPI_UNSIGNED_LONG_LONG, incoming.data(), 1, MPI_UNSIGNED_LONG_LONG, comm_);
  std::vector<std::vector<char>> result(size_);
  std::vector<MPI_Request> requests;
  const auto post = [&](auto call, auto* data, std::size_t bytes, int rank) {
    for (std::size_t done = 0; done < bytes; done += piece)
      call(data + done, static_cast<int>(std::min(piece, bytes - done)), MPI_BYTE, rank, 0, comm_, &requests.emplace_back());
  };
  for (int r = 0; r < size_; ++r) {
    result[r].resize(incoming[r]);
    if (r != rank_) post(MPI_Irecv, result[r].data(), result[r].size(), r);
  }
  for (int r = 0; r < size_; ++r)
    if (r != rank_) post(MPI_Isend, static_cast<const char*>(send[r].first), send[r].second, r);
  if (outgoing[rank_] > 0) std::memcpy(result[rank_].data(), send[rank_].first, outgoing[rank_]);
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return result;
}

}  // namespace mortise
