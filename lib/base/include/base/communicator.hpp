// The ranks of a run and the few collective calls that Mortise needs between them, on standard containers.
#pragma once

#include <mpi.h>

#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace mortise {

/// A group of ranks. A value: copies refer to the same group. Every member function but rank() and size() is collective.
class Communicator {
 public:
  /// Refers to `comm`, which outlives it: nothing is duplicated or freed.
  explicit Communicator(MPI_Comm comm = MPI_COMM_WORLD);

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool root() const { return rank_ == 0; }
  MPI_Comm mpi() const { return comm_; }

  /// Over all ranks, the same result on each. Collective, as is all that follows.
  double sum(double x) const { return reduce(x, MPI_SUM); }
  double min(double x) const { return reduce(x, MPI_MIN); }
  double max(double x) const { return reduce(x, MPI_MAX); }
  long long sum(long long x) const { return reduce(x, MPI_SUM); }
  long long min(long long x) const { return reduce(x, MPI_MIN); }
  long long max(long long x) const { return reduce(x, MPI_MAX); }
  bool any(bool x) const { return reduce(static_cast<long long>(x), MPI_MAX) != 0; }

  /// Element by element sum of `x` over the ranks; the same length everywhere.
  void sum_in_place(std::span<double> x) const;

  /// Sum of `x` over the ranks before this one.
  long long offset(long long x) const;

  /// `x` of rank `from`, on every rank; resized where needed.
  template <class T>
  void broadcast(std::vector<T>& x, int from = 0) const;
  void broadcast(std::string& x, int from = 0) const;

  /// The concatenation of all ranks' `x` in the order of ranks, on every rank. Only for what is of the coarse problem's size.
  template <class T>
  std::vector<T> all_gather(const std::vector<T>& x) const;

  /// send[r] goes to rank r; returns what came from each rank.
  template <class T>
  std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& send) const;

 private:
  double reduce(double x, MPI_Op op) const;
  long long reduce(long long x, MPI_Op op) const;
  void broadcast_bytes(void* data, std::size_t bytes, int from) const;
  std::vector<char> all_gather_bytes(const void* data, std::size_t bytes) const;
  std::vector<std::vector<char>> exchange_bytes(const std::vector<std::pair<const void*, std::size_t>>& send) const;

  MPI_Comm comm_;
  int rank_ = 0;
  int size_ = 1;
};

template <class T>
void Communicator::broadcast(std::vector<T>& x, int from) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  auto count = static_cast<unsigned long long>(x.size());
  broadcast_bytes(&count, sizeof count, from);
  x.resize(count);
  broadcast_bytes(x.data(), count * sizeof(T), from);
}

template <class T>
std::vector<T> Communicator::all_gather(const std::vector<T>& x) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  const auto bytes = all_gather_bytes(x.data(), x.size() * sizeof(T));
  std::vector<T> result(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(static_cast<void*>(result.data()), bytes.data(), bytes.size());
  return result;
}

template <class T>
std::vector<std::vector<T>> Communicator::exchange(const std::vector<std::vector<T>>& send) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<std::pair<const void*, std::size_t>> parts;
  for (const auto& part : send) parts.emplace_back(part.data(), part.size() * sizeof(T));
  const auto bytes = exchange_bytes(parts);
  std::vector<std::vector<T>> result(bytes.size());
  for (std::size_t r = 0; r < bytes.size(); ++r) {
    result[r].resize(bytes[r].size() / sizeof(T));
    if (!bytes[r].empty()) std::memcpy(static_cast<void*>(result[r].data()), bytes[r].data(), bytes[r].size());
  }
  return result;
}

}  // namespace mortise
