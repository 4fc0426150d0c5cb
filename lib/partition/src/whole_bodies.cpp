#include "partition/whole_bodies.hpp"

#include <algorithm>
#include <numeric>

#include "transfer.hpp"

namespace mortise::partition {

namespace {

// The pieces of one body as one mesh.
mesh::Mesh join(const std::vector<const mesh::Mesh*>& pieces)
{
  std::vector<std::pair<Global, Point>> nodes;
  for (const auto* piece : pieces)
    for (std::size_t n = 0; n < piece->node_count(); ++n) nodes.emplace_back(piece->node_id[n], piece->points[n]);
  std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  nodes.erase(std::unique(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
              nodes.end());
  mesh::Mesh whole;
  for (const auto& [id, point] : nodes) {
    whole.node_id.push_back(id);
    whole.points.push_back(point);
  }
  for (const auto* piece : pieces) {
    std::vector<Local> place;
    for (const Global id : piece->node_id)
      place.push_back(
          static_cast<Local>(std::lower_bound(whole.node_id.begin(), whole.node_id.end(), id) - whole.node_id.begin()));
    const auto first = static_cast<Local>(whole.cells.size());
    const auto append = [&](const mesh::Cells& from, mesh::Cells& to) {
      std::vector<Local> renumbered;
      for (std::size_t c = 0; c < from.size(); ++c) {
        renumbered.clear();
        for (const Local n : from[c]) renumbered.push_back(place[static_cast<std::size_t>(n)]);
        to.add(from.type[c], renumbered);
      }
    };
    const auto copy = [](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
    append(piece->cells, whole.cells);
    append(piece->facets.cells, whole.facets.cells);
    for (const Local parent : piece->facets.parent) whole.facets.parent.push_back(first + parent);
    copy(piece->facets.boundary, whole.facets.boundary);
    copy(piece->cell_id, whole.cell_id);
    copy(piece->cell_body, whole.cell_body);
    copy(piece->cell_volume, whole.cell_volume);
  }
  return whole;
}

}  // namespace

Decomposition whole_bodies(const Decomposition& decomposition, const Communicator& comm)
{
  std::vector<int> own;  // of each subdomain its body and whether it is a skin
  for (const auto& subdomain : decomposition.subdomains) own.insert(own.end(), {subdomain.body, subdomain.skin ? 1 : 0});
  const auto all = comm.all_gather(own);
  std::vector<Global> number;  // of each subdomain in the result
  Global count = 0;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    if (i == 0 || all[i] != all[i - 2] || all[i + 1] != 0) ++count;
    number.push_back(count - 1);
  }
  std::vector<double> cells(static_cast<std::size_t>(count), 0.0);
  for (const auto& subdomain : decomposition.subdomains)
    cells[static_cast<std::size_t>(number[static_cast<std::size_t>(subdomain.id)])] +=
        static_cast<double>(subdomain.mesh.cells.size());
  comm.sum_in_place(cells);
  Decomposition result;
  result.catalogue = decomposition.catalogue;
  result.clusters.resize(cells.size() + 1);
  std::iota(result.clusters.begin(), result.clusters.end(), Global{0});
  result.first = deal({cells.begin(), cells.end()}, result.clusters, comm.size());

  std::vector<std::vector<char>> send(static_cast<std::size_t>(comm.size()));
  for (const auto& subdomain : decomposition.subdomains)
    pack(subdomain, send[static_cast<std::size_t>(result.rank_of(number[static_cast<std::size_t>(subdomain.id)]))]);
  std::vector<Subdomain> received;  // in the order that they had, since ranks own ascending ranges of subdomains
  for (const auto& bytes : comm.exchange(send))
    for (auto& subdomain : unpack(bytes)) received.push_back(std::move(subdomain));
  for (std::size_t i = 0; i < received.size();) {
    const Global id = number[static_cast<std::size_t>(received[i].id)];
    const int body = received[i].body;
    std::vector<const mesh::Mesh*> pieces;
    std::size_t end = i;
    for (; end < received.size() && number[static_cast<std::size_t>(received[end].id)] == id; ++end)
      pieces.push_back(&received[end].mesh);
    if (received[i].skin) {
      received[i].id = id;
      result.subdomains.push_back(std::move(received[i]));
    } else
      result.subdomains.push_back({id, body, join(pieces)});
    i = end;
  }
  return result;
}

}  // namespace mortise::partition
