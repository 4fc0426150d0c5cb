// The places of keys in the order of all ranks' keys, without any rank that holds them all.
#pragma once

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"

namespace mortise {

/// The place of each of this rank's keys among those of all ranks in ascending order, from 0; equal ones by rank, and then as
/// they come in `own`. By regular sampling [Shi and Schaeffer, J. Parallel Distrib. Comput. 14 (1992)]: a rank sees some twice
/// its share of the keys at most, if few of them are equal, and as many samples as there are pairs of ranks. Collective.
template <class Key>
std::vector<Global> places_among_all(const std::vector<Key>& own, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::size_t> order(own.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return own[a] < own[b]; });

  std::vector<Key> samples;
  for (std::size_t r = 0; r < ranks && !own.empty(); ++r) samples.push_back(own[order[r * own.size() / ranks]]);
  samples = comm.all_gather(samples);
  std::sort(samples.begin(), samples.end());
  std::vector<Key> first;  // of each rank's part but the first
  for (std::size_t r = 1; r < ranks && !samples.empty(); ++r) first.push_back(samples[r * samples.size() / ranks]);

  std::vector<std::vector<Key>> send(ranks);
  for (const auto i : order)
    send[static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), own[i]) - first.begin())].push_back(own[i]);
  const auto received = comm.exchange(send);

  std::vector<std::tuple<Key, std::size_t, std::size_t>> part;  // key, rank, place in what it sent
  for (std::size_t r = 0; r < ranks; ++r)
    for (std::size_t i = 0; i < received[r].size(); ++i) part.emplace_back(received[r][i], r, i);
  std::sort(part.begin(), part.end());
  std::vector<std::vector<Global>> answer(ranks);
  for (std::size_t r = 0; r < ranks; ++r) answer[r].resize(received[r].size());
  Global place = comm.offset(static_cast<long long>(part.size()));
  for (const auto& [key, rank, i] : part) answer[rank][i] = place++;

  std::vector<Global> result(own.size());
  std::size_t next = 0;
  for (const auto& places : comm.exchange(answer))
    for (const Global p : places) result[order[next++]] = p;
  return result;
}

}  // namespace mortise
