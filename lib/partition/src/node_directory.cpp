#include "partition/node_directory.hpp"

#include <algorithm>
#include <tuple>

#include "base/packed.hpp"
#include "mesh/topology.hpp"

namespace mortise::partition {

namespace {

struct Entry {
  Global node;
  Copy copy;
};

// Appends copies to a message.
void write(std::span<const Copy> copies, PackedWriter& to)
{
  std::vector<Global> subdomains, nodes;
  std::vector<double> weights;
  for (const auto& copy : copies) {
    subdomains.push_back(copy.subdomain);
    nodes.push_back(copy.node);
    weights.push_back(copy.weight);
  }
  to.integers(subdomains);
  to.integers(nodes);
  to.numbers(weights);
}

std::vector<Copy> read_copies(PackedReader& from)
{
  const auto subdomains = from.integers(), nodes = from.integers();
  const auto weights = from.numbers();
  std::vector<Copy> copies;
  for (std::size_t i = 0; i < nodes.size(); ++i) copies.push_back({subdomains[i], static_cast<Local>(nodes[i]), weights[i]});
  return copies;
}

// The lists of whole numbers that ranks send each other, and what they got. Collective.
std::vector<std::vector<Global>> exchange_packed(const std::vector<std::vector<Global>>& lists, const Communicator& comm)
{
  std::vector<std::vector<char>> send(lists.size());
  PackedWriter writer;
  for (std::size_t r = 0; r < lists.size(); ++r)
    if (!lists[r].empty()) {
      writer.integers(lists[r]);
      send[r] = writer.take();
    }
  std::vector<std::vector<Global>> result;
  for (const auto& part : comm.exchange(send))
    result.push_back(part.empty() ? std::vector<Global>() : PackedReader(part).integers());
  return result;
}

}  // namespace

NodeDirectory::NodeDirectory(const Decomposition& decomposition, const std::vector<std::vector<double>>& weight,
                             const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Global>> nodes(ranks);
  std::vector<std::vector<Copy>> copies(ranks);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    for (const Local n : surface_.emplace_back(surface_nodes(subdomain))) {
      const Global id = subdomain.mesh.node_id[static_cast<std::size_t>(n)];
      const auto rank = static_cast<std::size_t>(id) % ranks;
      nodes[rank].push_back(id);
      copies[rank].push_back({subdomain.id, n, weight[s][static_cast<std::size_t>(n)]});
    }
  }
  std::vector<std::vector<char>> send;
  for (std::size_t r = 0; r < ranks; ++r) {
    PackedWriter writer;
    if (!nodes[r].empty()) {
      writer.integers(nodes[r]);
      write(copies[r], writer);
    }
    send.push_back(writer.take());
  }
  std::vector<Entry> entries;
  for (const auto& part : comm.exchange(send)) {
    if (part.empty()) continue;
    PackedReader reader(part);
    const auto received = reader.integers();
    const auto of_nodes = read_copies(reader);
    for (std::size_t i = 0; i < received.size(); ++i) entries.push_back({received[i], of_nodes[i]});
  }
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
  const auto questions = exchange_packed(asked, comm);
  std::vector<std::vector<Global>> counts(ranks);
  std::vector<std::vector<Copy>> copies(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const Global node : questions[r]) {
      const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node);
      if (at == nodes_.end() || *at != node) {
        counts[r].push_back(0);
        continue;
      }
      const auto found = entries_[static_cast<std::size_t>(at - nodes_.begin())];
      counts[r].push_back(static_cast<Global>(found.size()));
      copies[r].insert(copies[r].end(), found.begin(), found.end());
    }
  std::vector<std::vector<char>> answers(ranks);
  PackedWriter writer;
  for (std::size_t r = 0; r < ranks; ++r)
    if (!counts[r].empty()) {
      writer.integers(counts[r]);
      write(copies[r], writer);
      answers[r] = writer.take();
    }
  std::vector<std::vector<Global>> count_answers(ranks);
  std::vector<std::vector<Copy>> copy_answers(ranks);
  const auto received = comm.exchange(answers);
  for (std::size_t r = 0; r < ranks; ++r)
    if (!received[r].empty()) {
      PackedReader reader(received[r]);
      count_answers[r] = reader.integers();
      copy_answers[r] = read_copies(reader);
    }
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
    Local subdomain, node;  // the first copy on that rank
  };
  const auto ranks = static_cast<std::size_t>(comm.size()), here = static_cast<std::size_t>(comm.rank());
  const Global base = decomposition.first[here];
  // Each copy sends its row to every rank that has copies, which adds it to all of them, its own included. Subdomains are
  // numbered rank by rank: what is added in the order of ranks, and on each of subdomains, is added in the order of subdomains.
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
    auto last = here;  // copies stand rank by rank
    for (const auto& copy : interface.copies[s][i]) {
      const auto rank = static_cast<std::size_t>(decomposition.rank_of(copy.subdomain));
      if (rank != here && rank != last) {
        heads[rank].push_back({static_cast<Local>(copy.subdomain - decomposition.first[rank]), copy.node});
        rows[rank].insert(rows[rank].end(), own, own + width);
      }
      last = rank;
    }
  });
  const auto head_in = comm.exchange(heads);
  const auto row_in = comm.exchange(rows);
  // To the copies on this rank of the i-th shared node of subdomain s.
  const auto add = [&](std::size_t s, std::size_t i, const double* other) {
    for (const auto& copy : interface.copies[s][i]) {
      if (copy.subdomain < base || copy.subdomain >= decomposition.first[here + 1]) continue;
      if (auto row = row_at(static_cast<std::size_t>(copy.subdomain - base), copy.node); row.size() > 0)
        row += Eigen::Map<const Eigen::RowVectorXd>(other, width);
    }
  };
  for (std::size_t r = 0; r < ranks; ++r) {
    for (std::size_t i = 0; i < head_in[r].size(); ++i) {
      const auto s = static_cast<std::size_t>(head_in[r][i].subdomain);
      const auto& shared = interface.nodes[s];
      const auto at = std::ranges::lower_bound(shared, head_in[r][i].node) - shared.begin();
      add(s, static_cast<std::size_t>(at), row_in[r].data() + static_cast<std::size_t>(width) * i);
    }
    if (r == here) each_own([&](auto&, std::size_t s, std::size_t i, const double* own) { add(s, i, own); });
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
