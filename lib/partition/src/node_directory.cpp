#include "partition/node_directory.hpp"

#include <algorithm>
#include <tuple>

#include "mesh/topology.hpp"

namespace mortise::partition {

namespace {

struct Entry {
  Global node;
  Copy copy;
};

}  // namespace

NodeDirectory::NodeDirectory(const Decomposition& decomposition, const std::vector<std::vector<double>>& weight,
                             const Communicator& comm)
{
  std::vector<std::vector<Entry>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    for (const Local n : surface_.emplace_back(surface_nodes(subdomain))) {
      const Global id = subdomain.mesh.node_id[static_cast<std::size_t>(n)];
      send[static_cast<std::size_t>(id % comm.size())].push_back({id, {subdomain.id, n, weight[s][static_cast<std::size_t>(n)]}});
    }
  }
  std::vector<Entry> entries;
  for (const auto& part : comm.exchange(send)) entries.insert(entries.end(), part.begin(), part.end());
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.node, a.copy.subdomain) < std::tie(b.node, b.copy.subdomain);
  });
  entries_.offset.push_back(0);
  for (const auto& entry : entries) {
    if (nodes_.empty() || nodes_.back() != entry.node) {
      nodes_.push_back(entry.node);
      entries_.offset.push_back(entries_.copies.size());
    }
    entries_.copies.push_back(entry.copy);
    entries_.offset.back() = entries_.copies.size();
  }
}

NodeDirectory::Found NodeDirectory::find(std::span<const Global> nodes, const Communicator& comm) const
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Global>> asked(ranks);
  for (const Global node : nodes) asked[static_cast<std::size_t>(node) % ranks].push_back(node);
  const auto questions = comm.exchange(asked);
  std::vector<std::vector<int>> counts(ranks);
  std::vector<std::vector<Copy>> copies(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const Global node : questions[r]) {
      const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node);
      if (at == nodes_.end() || *at != node) {
        counts[r].push_back(0);
        continue;
      }
      const auto found = entries_[static_cast<std::size_t>(at - nodes_.begin())];
      counts[r].push_back(static_cast<int>(found.size()));
      copies[r].insert(copies[r].end(), found.begin(), found.end());
    }
  const auto count_answers = comm.exchange(counts);
  const auto copy_answers = comm.exchange(copies);
  Found result;
  result.offset.push_back(0);
  std::vector<std::size_t> next(ranks, 0), next_copy(ranks, 0);
  for (const Global node : nodes) {
    const auto r = static_cast<std::size_t>(node) % ranks;
    const auto count = static_cast<std::size_t>(count_answers[r][next[r]++]);
    const auto begin = copy_answers[r].begin() + static_cast<std::ptrdiff_t>(next_copy[r]);
    result.copies.insert(result.copies.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
    next_copy[r] += count;
    result.offset.push_back(result.copies.size());
  }
  return result;
}

std::vector<Local> surface_nodes(const Subdomain& subdomain)
{
  const auto& mesh = subdomain.mesh;
  std::vector<bool> on(mesh.node_count(), subdomain.skin);
  if (!subdomain.skin)
    for (const auto& border : mesh::border_faces(mesh.cells)) {
      const auto cell = static_cast<std::size_t>(border.cell);
      for (const int n : mesh::faces(mesh.cells.type[cell])[static_cast<std::size_t>(border.face)].nodes)
        on[static_cast<std::size_t>(mesh.cells[cell][static_cast<std::size_t>(n)])] = true;
    }
  std::vector<Local> nodes;
  for (std::size_t n = 0; n < on.size(); ++n)
    if (on[n]) nodes.push_back(static_cast<Local>(n));
  return nodes;
}

Interface find_interface(const Decomposition& decomposition, const NodeDirectory& directory, const Communicator& comm)
{
  std::vector<Global> nodes;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
    for (const Local n : directory.surface(s))
      nodes.push_back(decomposition.subdomains[s].mesh.node_id[static_cast<std::size_t>(n)]);
  const auto found = directory.find(nodes, comm);
  Interface interface;
  std::size_t next = 0;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    auto& shared = interface.nodes.emplace_back();
    auto& copies = interface.copies.emplace_back();
    copies.offset.push_back(0);
    for (const Local n : directory.surface(s)) {
      const auto all = found[next++];
      if (all.size() < 2) continue;
      shared.push_back(n);
      copies.copies.insert(copies.copies.end(), all.begin(), all.end());
      copies.offset.push_back(copies.copies.size());
    }
  }
  return interface;
}

void sum_rows(const Decomposition& decomposition, const Interface& interface, Eigen::Index width, const RowOfNode& row_at,
              const Communicator& comm)
{
  struct Head {
    Global to;
    Local node;
  };
  const auto ranks = static_cast<std::size_t>(comm.size()), here = static_cast<std::size_t>(comm.rank());
  const Global base = decomposition.first[here];
  // Each copy sends its row to all copies, itself included. Subdomains are numbered rank by rank: what is added in the order of
  // ranks, and on each of subdomains, is added in the order of subdomains.
  std::vector<std::vector<Head>> heads(ranks);
  std::vector<std::vector<double>> rows(ranks), before;
  const auto each_own = [&](const auto& visit) {
    for (std::size_t s = 0; s < interface.nodes.size(); ++s)
      for (std::size_t i = 0; i < interface.nodes[s].size(); ++i)
        if (auto row = row_at(s, interface.nodes[s][i]); row.size() > 0)
          visit(row, s, i, before[s].data() + static_cast<std::size_t>(width) * i);
  };
  for (const auto& nodes : interface.nodes) before.emplace_back(static_cast<std::size_t>(width) * nodes.size());
  each_own([&](auto& row, std::size_t s, std::size_t i, double* own) {
    Eigen::Map<Eigen::RowVectorXd>(own, width) = row;
    row.setZero();
    for (const auto& copy : interface.copies[s][i]) {
      const auto rank = static_cast<std::size_t>(decomposition.rank_of(copy.subdomain));
      if (rank == here) continue;
      heads[rank].push_back({copy.subdomain, copy.node});
      rows[rank].insert(rows[rank].end(), own, own + width);
    }
  });
  const auto head_in = comm.exchange(heads);
  const auto row_in = comm.exchange(rows);
  const auto add = [&](const Head& head, const double* other) {
    if (auto row = row_at(static_cast<std::size_t>(head.to - base), head.node); row.size() > 0)
      row += Eigen::Map<const Eigen::RowVectorXd>(other, width);
  };
  for (std::size_t r = 0; r < ranks; ++r) {
    for (std::size_t i = 0; i < head_in[r].size(); ++i)
      add(head_in[r][i], row_in[r].data() + static_cast<std::size_t>(width) * i);
    if (r != here) continue;
    each_own([&](auto&, std::size_t s, std::size_t i, const double* own) {
      for (const auto& copy : interface.copies[s][i])
        if (static_cast<std::size_t>(decomposition.rank_of(copy.subdomain)) == here) add({copy.subdomain, copy.node}, own);
    });
  }
}

void sum_over_copies(const Decomposition& decomposition, const Interface& interface, std::vector<Eigen::MatrixXd>& values,
                     const Communicator& comm)
{
  const auto width = static_cast<Eigen::Index>(comm.max(static_cast<long long>(values.empty() ? 0 : values[0].cols())));
  sum_rows(
      decomposition, interface, width, [&](std::size_t s, Local n) { return row_of(values[s], n); }, comm);
}

}  // namespace mortise::partition
