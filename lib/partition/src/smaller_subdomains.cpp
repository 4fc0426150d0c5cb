#include "partition/smaller_subdomains.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/topology.hpp"
#include "partition/decompose.hpp"
#include "transfer.hpp"

namespace mortise::partition {

Decomposition smaller_subdomains(const Decomposition& decomposition, int unknowns, const Communicator& comm)
{
  std::vector<Subdomain> pieces;
  for (const auto& subdomain : decomposition.subdomains) {
    const double size = decomposition.catalogue.dimension * static_cast<double>(subdomain.mesh.node_count());
    const int count = static_cast<int>(std::lround(size / unknowns));
    if (subdomain.skin || count < 2) {
      pieces.push_back(subdomain);
      continue;
    }
    const auto label = cut(subdomain.mesh.cells, count);
    std::vector<std::vector<Local>> cells(1 + static_cast<std::size_t>(*std::max_element(label.begin(), label.end())));
    for (std::size_t c = 0; c < label.size(); ++c) cells[static_cast<std::size_t>(label[c])].push_back(static_cast<Local>(c));
    mesh::Submeshes submeshes(subdomain.mesh);
    for (const auto& list : cells) pieces.push_back({0, subdomain.body, submeshes(list)});
  }
  std::vector<long long> own;  // cells of each piece
  for (const auto& piece : pieces) own.push_back(static_cast<long long>(piece.mesh.cells.size()));
  const auto counts = comm.all_gather(std::vector<long long>{static_cast<long long>(pieces.size())});
  Global id = std::accumulate(counts.begin(), counts.begin() + comm.rank(), Global{0});
  const auto weight = comm.all_gather(own);

  Decomposition result;
  result.catalogue = decomposition.catalogue;
  result.clusters.resize(weight.size() + 1);
  std::iota(result.clusters.begin(), result.clusters.end(), Global{0});
  result.first = deal(weight, result.clusters, comm.size());
  std::vector<std::vector<char>> send(static_cast<std::size_t>(comm.size()));
  for (auto& piece : pieces) {
    piece.id = id++;
    pack(piece, send[static_cast<std::size_t>(result.rank_of(piece.id))]);
    piece = {};
  }
  for (const auto& bytes : comm.exchange(send))  // in ascending order, as ranks own ascending ranges
    for (auto& subdomain : unpack(bytes)) result.subdomains.push_back(std::move(subdomain));
  return result;
}

}  // namespace mortise::partition
