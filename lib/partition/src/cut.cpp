#include <metis.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "mesh/topology.hpp"
#include "partition/decompose.hpp"

namespace mortise::partition {

namespace {

// Of so many cells METIS's cuts differ by little, and each takes longer than the rest of the reading.
constexpr idx_t many = 50'000;

// `weight`: of each entry of graph.cells, or empty.
std::vector<int> metis(const mesh::Neighbours& graph, std::vector<idx_t> weight, int parts)
{
  auto vertices = static_cast<idx_t>(graph.offset.size() - 1);
  std::vector<idx_t> label(static_cast<std::size_t>(vertices), 0);
  if (parts < 2 || vertices < 2) return {label.begin(), label.end()};
  std::vector<idx_t> offset(graph.offset.begin(), graph.offset.end()), adjacent(graph.cells.begin(), graph.cells.end());
  idx_t constraints = 1, wanted = std::min<idx_t>(parts, vertices), cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NCUTS] = vertices < many ? 4 : 1;  // the best of so many
  options[METIS_OPTION_CONTIG] = 1;
  options[METIS_OPTION_UFACTOR] = 50;
  const auto run = [&] {
    return METIS_PartGraphKway(&vertices, &constraints, offset.data(), adjacent.data(), nullptr, nullptr,
                               weight.empty() ? nullptr : weight.data(), &wanted, nullptr, nullptr, options, &cut, label.data());
  };
  int status = run();
  if (status != METIS_OK) {  // a disconnected graph cannot be cut into contiguous parts at once
    options[METIS_OPTION_CONTIG] = 0;
    status = run();
  }
  if (status != METIS_OK) throw Error(ExitStatus::machine, "METIS could not cut a body into subdomains");
  return {label.begin(), label.end()};
}

// Every connected piece of a part but the largest joins the part with which it shares most faces, the smallest pieces first.
void join_islands(const mesh::Neighbours& graph, std::vector<int>& label)
{
  for (int round = 0; round < 100; ++round) {
    const auto piece = mesh::connected_parts(graph, label);
    const int pieces = label.empty() ? 0 : 1 + *std::max_element(piece.begin(), piece.end());
    std::vector<int> size(static_cast<std::size_t>(pieces), 0);
    for (const int p : piece) ++size[static_cast<std::size_t>(p)];
    std::map<int, int> main;  // largest piece of each part
    for (std::size_t c = 0; c < label.size(); ++c) {
      const auto [at, fresh] = main.emplace(label[c], piece[c]);
      if (!fresh && size[static_cast<std::size_t>(piece[c])] > size[static_cast<std::size_t>(at->second)]) at->second = piece[c];
    }
    std::map<int, std::map<int, int>> border;  // island -> part of a neighbour -> common faces
    for (std::size_t c = 0; c < label.size(); ++c) {
      if (main[label[c]] == piece[c]) continue;
      for (const Local other : graph[c])
        if (label[static_cast<std::size_t>(other)] != label[c]) ++border[piece[c]][label[static_cast<std::size_t>(other)]];
    }
    if (border.empty()) return;
    std::map<int, int> target;
    for (const auto& [island, neighbours] : border)
      target[island] = std::max_element(neighbours.begin(), neighbours.end(), [](const auto& a, const auto& b) {
                         return a.second < b.second;
                       })->first;
    for (std::size_t c = 0; c < label.size(); ++c)
      if (const auto found = target.find(piece[c]); found != target.end()) label[c] = found->second;
  }
}

std::vector<int> cut_graph(const mesh::Neighbours& graph, std::vector<idx_t> weight, int parts)
{
  auto label = metis(graph, std::move(weight), parts);
  join_islands(graph, label);
  return mesh::connected_parts(graph, label);
}

}  // namespace

std::vector<int> cut(const mesh::Cells& cells, int parts)
{
  return cut_graph(mesh::face_neighbours(cells), {}, parts);
}

std::vector<int> cluster(const mesh::Cells& cells, const std::vector<int>& subdomain, int size)
{
  const auto between = mesh::face_neighbours(cells);
  std::map<std::pair<int, int>, idx_t> common;  // faces of each pair of subdomains, both ways
  for (std::size_t c = 0; c < subdomain.size(); ++c)
    for (const Local other : between[c])
      if (const int a = subdomain[c], b = subdomain[static_cast<std::size_t>(other)]; a != b) ++common[{a, b}];
  const int count = subdomain.empty() ? 0 : 1 + *std::max_element(subdomain.begin(), subdomain.end());
  mesh::Neighbours graph;
  std::vector<idx_t> weight;
  auto next = common.begin();
  for (int s = 0; s < count; ++s) {
    for (; next != common.end() && next->first.first == s; ++next) {
      graph.cells.push_back(next->first.second);
      weight.push_back(next->second);
    }
    graph.offset.push_back(static_cast<Local>(graph.cells.size()));
  }
  return cut_graph(graph, std::move(weight), std::max(1, (count + size / 2) / size));
}

}  // namespace mortise::partition
