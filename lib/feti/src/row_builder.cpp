#include "row_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/packed.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

namespace {

// The coefficients of gluing row k = 1 .. copies-1 at copies 0 .. k.
std::vector<double> gluing_coefficients(std::span<const partition::Copy> copies, std::size_t k)
{
  double sum = 0;
  for (std::size_t q = 0; q < k; ++q) sum += copies[q].weight;
  const double next = copies[k].weight;
  const double a = std::sqrt(next / (sum * (sum + next)));
  std::vector<double> row;
  for (std::size_t q = 0; q < k; ++q) row.push_back(a * copies[q].weight);
  row.push_back(-a * sum);
  return row;
}

double total_weight(std::span<const partition::Copy> copies)
{
  return std::accumulate(copies.begin(), copies.end(), 0.0,
                         [](double sum, const partition::Copy& copy) { return sum + copy.weight; });
}

}  // namespace

RowBuilder::RowBuilder(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
                       const Communicator& comm)
    : decomposition_(decomposition),
      directory_(directory),
      comm_(comm),
      dimension_(decomposition.catalogue.dimension),
      send_(static_cast<std::size_t>(comm.size()))
{
}

void RowBuilder::begin(std::size_t count)
{
  const auto mine = static_cast<long long>(count);
  next_ = end_ + comm_.offset(mine);
  end_ += comm_.sum(mine);
}

void RowBuilder::own(Global row, double scale)
{
  owned_.push_back(row);
  scale_.push_back(scale);
}

void RowBuilder::send(const Piece& piece)
{
  send_[static_cast<std::size_t>(decomposition_.rank_of(piece.subdomain))].push_back(piece);
}

void RowBuilder::glue(const partition::Interface& interface)
{
  const auto& subdomains = decomposition_.subdomains;
  const auto for_each_node = [&](const auto& visit) {  // whose first copy is here
    for (std::size_t s = 0; s < subdomains.size(); ++s)
      for (std::size_t i = 0; i < interface.nodes[s].size(); ++i)
        if (const auto copies = interface.copies[s][i]; copies[0].subdomain == subdomains[s].id) visit(copies);
  };
  std::size_t count = 0;
  for_each_node([&](const auto& copies) { count += (copies.size() - 1) * static_cast<std::size_t>(dimension_); });
  begin(count);
  for_each_node([&](const auto& copies) {
    for (std::size_t k = 1; k < copies.size(); ++k) {
      const auto coefficients = gluing_coefficients(copies, k);
      for (int c = 0; c < dimension_; ++c, ++next_) {
        for (std::size_t q = 0; q <= k; ++q) send({copies[q].subdomain, next_, copies[q].node * dimension_ + c, coefficients[q]});
        own(next_, -coefficients.back());  // over the row: mean of the copies before less this copy
      }
    }
  });
}

void RowBuilder::add(std::span<const constraint::PrescribedDof> prescribed,
                     std::span<const constraint::SkewSupport> skew_supports)
{
  std::vector<Global> nodes;
  for (const auto& dof : prescribed) nodes.push_back(dof.node);
  for (const auto& support : skew_supports) nodes.push_back(support.node);
  const auto copies = directory_.find(nodes, comm_);
  for (std::size_t i = 0; i < nodes.size(); ++i, ++next_) {
    const double factor = std::sqrt(total_weight(copies[i]));
    const auto* along = i < prescribed.size() ? nullptr : &skew_supports[i - prescribed.size()];
    for (const auto& copy : copies[i])
      for (int c = 0; c < dimension_; ++c) {
        const double part = along ? along->direction[static_cast<std::size_t>(c)] : (c == prescribed[i].component ? 1.0 : 0.0);
        if (part != 0) send({copy.subdomain, next_, copy.node * dimension_ + c, part * copy.weight / factor});
      }
    own(next_, factor);
  }
}

void RowBuilder::find_copies(std::vector<Global> nodes)
{
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  nodes_ = std::move(nodes);
  copies_ = directory_.find(nodes_, comm_);
}

std::span<const partition::Copy> RowBuilder::copies_of(Global node) const
{
  return copies_[static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin())];
}

// What makes a row a unit vector in D^-1 plus the compliance, the copies' averages taken together.
double RowBuilder::unit_factor(std::span<const constraint::Entry> entries, double compliance) const
{
  double square = compliance;
  for (const auto& entry : entries) square += entry.coefficient * entry.coefficient / total_weight(copies_of(entry.node));
  return 1 / std::sqrt(square);
}

void RowBuilder::send(std::span<const constraint::Entry> entries, Global row, double factor)
{
  for (const auto& entry : entries) {
    const auto copies = copies_of(entry.node);
    const double share = factor * entry.coefficient / total_weight(copies);
    for (const auto& copy : copies) send({copy.subdomain, row, copy.node * dimension_ + entry.component, share * copy.weight});
  }
}

void RowBuilder::add(std::span<const constraint::MeanMotion> means)
{
  for (const auto& mean : means) {
    own(next_, unit_factor(mean.entries));
    send(mean.entries, next_++, scale_.back());
  }
}

void RowBuilder::add(const constraint::Springs& springs)
{
  for (const std::size_t row : springs.own) {
    const auto diagonal = springs.stiffness.coeff(static_cast<int>(row), static_cast<int>(row));
    own(next_, unit_factor(springs.rows[row].entries, 1 / diagonal));
    send(springs.rows[row].entries, next_++, scale_.back());
  }
}

void RowBuilder::add(const constraint::Contacts& contacts)
{
  for (const auto& node : contacts.nodes) {
    const double factor = unit_factor(contacts.rows[node.row]);
    for (std::size_t r = node.row; r <= node.row + node.tangents.size(); ++r) {
      const Global row = next_ + static_cast<Global>(r);
      send(contacts.rows[r], row, factor);
      own(row, factor);
    }
  }
}

void RowBuilder::add(std::span<const SubdomainRow> rows)
{
  const auto& subdomains = decomposition_.subdomains;
  for (const auto& extra : rows) {
    Global lowest = decomposition_.subdomain_count();
    for (std::size_t s = 0; s < subdomains.size(); ++s) {
      const auto& coefficients = extra.coefficients[s];
      if (coefficients.size() == 0) continue;
      lowest = std::min(lowest, subdomains[s].id);
      for (Local i = 0; i < coefficients.size(); ++i) send({subdomains[s].id, end_, i, coefficients[i]});
    }
    if (decomposition_.rank_of(comm_.min(lowest)) == comm_.rank()) own(end_, extra.scale);
    ++end_;
  }
}

std::vector<Piece> RowBuilder::receive()
{
  std::vector<std::vector<char>> messages;
  for (const auto& part : send_) {
    std::vector<Global> subdomains, rows, unknowns;
    std::vector<double> coefficients;
    for (const auto& piece : part) {
      subdomains.push_back(piece.subdomain);
      rows.push_back(piece.row);
      unknowns.push_back(piece.unknown);
      coefficients.push_back(piece.coefficient);
    }
    PackedWriter writer;
    if (!part.empty()) {
      for (const auto* list : {&subdomains, &rows, &unknowns}) writer.integers(*list);
      writer.numbers(coefficients);
    }
    messages.push_back(writer.take());
  }
  send_.clear();
  std::vector<Piece> all;
  for (const auto& message : comm_.exchange(messages)) {
    if (message.empty()) continue;
    PackedReader reader(message);
    const auto subdomains = reader.integers(), rows = reader.integers(), unknowns = reader.integers();
    const auto coefficients = reader.numbers();
    for (std::size_t i = 0; i < rows.size(); ++i)
      all.push_back({subdomains[i], rows[i], static_cast<Local>(unknowns[i]), coefficients[i]});
  }
  std::sort(all.begin(), all.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.subdomain, a.row, a.unknown) < std::tie(b.subdomain, b.row, b.unknown);
  });
  return all;
}

}  // namespace mortise::feti
