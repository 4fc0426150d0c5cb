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

namespace {

// row(s, n): where values[s] has shared node n of subdomain s.
template <class Row>
void sum_rows(const Decomposition& decomposition, const Interface& interface, std::vector<Eigen::MatrixXd>& values,
              const Communicator& comm, const Row& row_of)
{
  if (comm.max(static_cast<long long>(values.size())) == 0) return;
  const auto width = static_cast<Eigen::Index>(comm.max(static_cast<long long>(values.empty() ? 0 : values[0].cols())));
  // Each copy sends its row to all other copies; what arrives is sorted by node and by subdomain of origin before it is added. On
  // this rank rows are read where one copy of them stands.
  struct Head {
    Global to, from;
    Local node;
  };
  struct Term {
    Head head;
    const double* row;
  };
  const auto ranks = static_cast<std::size_t>(comm.size()), here = static_cast<std::size_t>(comm.rank());
  std::vector<std::vector<Head>> heads(ranks);
  std::vector<std::vector<double>> rows(ranks), before;
  std::vector<Term> terms;
  for (std::size_t s = 0; s < interface.nodes.size(); ++s) {
    auto& own = before.emplace_back(static_cast<std::size_t>(width) * interface.nodes[s].size());
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      double* const row = own.data() + static_cast<std::size_t>(width) * i;
      Eigen::Map<Eigen::RowVectorXd>(row, width) = values[s].row(row_of(s, interface.nodes[s][i]));
      for (const auto& copy : interface.copies[s][i]) {
        const auto rank = static_cast<std::size_t>(decomposition.rank_of(copy.subdomain));
        const Head head{copy.subdomain, decomposition.subdomains[s].id, copy.node};
        if (rank == here) {
          terms.push_back({head, row});
          continue;
        }
        heads[rank].push_back(head);
        rows[rank].insert(rows[rank].end(), row, row + width);
      }
    }
  }
  const auto head_in = comm.exchange(heads);
  const auto row_in = comm.exchange(rows);
  for (std::size_t r = 0; r < ranks; ++r)
    for (std::size_t i = 0; i < head_in[r].size(); ++i)
      terms.push_back({head_in[r][i], row_in[r].data() + static_cast<std::size_t>(width) * i});
  std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
    return std::tie(a.head.to, a.head.node, a.head.from) < std::tie(b.head.to, b.head.node, b.head.from);
  });
  const Global base = decomposition.first[static_cast<std::size_t>(comm.rank())];
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto& head = terms[i].head;
    const auto s = static_cast<std::size_t>(head.to - base);
    auto row = values[s].row(row_of(s, head.node));
    if (i == 0 || terms[i - 1].head.to != head.to || terms[i - 1].head.node != head.node) row.setZero();
    row += Eigen::Map<const Eigen::RowVectorXd>(terms[i].row, width);
  }
}

}  // namespace

void sum_over_copies(const Decomposition& decomposition, const Interface& interface, std::vector<Eigen::MatrixXd>& values,
                     const Communicator& comm)
{
  sum_rows(decomposition, interface, values, comm, [](std::size_t, Local n) { return n; });
}

void sum_shared(const Decomposition& decomposition, const Interface& interface, std::vector<Eigen::MatrixXd>& values,
                const Communicator& comm)
{
  sum_rows(decomposition, interface, values, comm, [&](std::size_t s, Local n) {
    const auto& nodes = interface.nodes[s];
    return std::lower_bound(nodes.begin(), nodes.end(), n) - nodes.begin();
  });
}

}  // namespace mortise::partition
