#include "feti/jump_operator.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace mortise::feti {

namespace {

// One coefficient of B, on its way to the rank of its subdomain.
struct Piece {
  Global subdomain;
  Global row;
  Local unknown;
  double coefficient;
};

// Collects the pieces of rows, to be sent to the ranks of their subdomains.
class Assembly {
 public:
  Assembly(const partition::Decomposition& decomposition, const Communicator& comm)
      : decomposition_(decomposition), comm_(comm), send_(static_cast<std::size_t>(comm.size()))
  {
  }

  void add(const Piece& piece) { send_[static_cast<std::size_t>(decomposition_.rank_of(piece.subdomain))].push_back(piece); }
  void add_local(const Piece& piece) { send_[static_cast<std::size_t>(comm_.rank())].push_back(piece); }

  // Pieces of this rank's subdomains, ordered by subdomain, row and unknown. Collective.
  std::vector<Piece> receive()
  {
    std::vector<Piece> all;
    for (auto& part : comm_.exchange(send_)) {
      all.insert(all.end(), part.begin(), part.end());
      part.clear();
    }
    send_.clear();
    std::sort(all.begin(), all.end(), [](const Piece& a, const Piece& b) {
      return std::tie(a.subdomain, a.row, a.unknown) < std::tie(b.subdomain, b.row, b.unknown);
    });
    return all;
  }

 private:
  const partition::Decomposition& decomposition_;
  const Communicator& comm_;
  std::vector<std::vector<Piece>> send_;
};

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

struct Numbering {
  Global start = 0;  // number of the first row of this rank
  Global total = 0;  // over all ranks
};

Numbering number(std::size_t count, const Communicator& comm)
{
  const auto mine = static_cast<long long>(count);
  return {comm.offset(mine), comm.sum(mine)};
}

// Gluing rows of the nodes whose lowest copy is on this rank; returns how many rows this rank owns and the total.
std::pair<std::size_t, Global> glue(const partition::Decomposition& decomposition, const partition::Interface& interface,
                                    int dimension, const Communicator& comm, Assembly& assembly)
{
  std::size_t owned = 0;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      const auto copies = interface.copies[s][i];
      if (copies[0].subdomain == decomposition.subdomains[s].id)
        owned += (copies.size() - 1) * static_cast<std::size_t>(dimension);
    }
  const Numbering numbering = number(owned, comm);
  Global row = numbering.start;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      const auto copies = interface.copies[s][i];
      if (copies[0].subdomain != decomposition.subdomains[s].id) continue;
      for (std::size_t k = 1; k < copies.size(); ++k) {
        const auto coefficients = gluing_coefficients(copies, k);
        for (int c = 0; c < dimension; ++c, ++row)
          for (std::size_t q = 0; q <= k; ++q)
            assembly.add({copies[q].subdomain, row, copies[q].node * dimension + c, coefficients[q]});
      }
    }
  return {owned, numbering.total};
}

double total_weight(std::span<const partition::Copy> copies)
{
  return std::accumulate(copies.begin(), copies.end(), 0.0,
                         [](double sum, const partition::Copy& copy) { return sum + copy.weight; });
}

}  // namespace

JumpOperator::JumpOperator(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
                           const partition::Interface& interface, std::span<const constraint::PrescribedDof> prescribed,
                           std::span<const constraint::SkewSupport> skew_supports, const constraint::Contacts& contacts,
                           std::span<const SubdomainRow> extra, const Communicator& comm,
                           std::span<const constraint::MeanMotion> mean_motions, const constraint::Springs& springs)
{
  const int dimension = decomposition.catalogue.dimension;
  Assembly assembly(decomposition, comm);
  const auto [glued, glued_total] = glue(decomposition, interface, dimension, comm, assembly);
  const Numbering dirichlet_numbers =
      number(prescribed.size() + skew_supports.size() + mean_motions.size() + springs.own.size(), comm);
  const Numbering contact_numbers = number(contacts.rows.size(), comm);
  const Global dirichlet_base = glued_total, contact_base = dirichlet_base + dirichlet_numbers.total,
               extra_base = contact_base + contact_numbers.total;
  contact_rows_ = {contact_base, extra_base};

  // Owned rows: their numbers and scales.
  std::vector<Global> owned;
  std::vector<double> scale(glued, 1.0);
  const Global glue_start = comm.offset(static_cast<long long>(glued));
  for (std::size_t i = 0; i < glued; ++i) owned.push_back(glue_start + static_cast<Global>(i));
  ranges_.dirichlet = static_cast<Local>(owned.size());

  std::vector<Global> nodes;
  for (const auto& h : prescribed) nodes.push_back(h.node);
  for (const auto& i : skew_supports) nodes.push_back(i.node);
  const auto prescribed_copies = directory.find(nodes, comm);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Global row = dirichlet_base + dirichlet_numbers.start + static_cast<Global>(i);
    const double factor = std::sqrt(total_weight(prescribed_copies[i]));
    const auto* along = i < prescribed.size() ? nullptr : &skew_supports[i - prescribed.size()];
    for (const auto& copy : prescribed_copies[i])
      for (int c = 0; c < dimension; ++c) {
        const double part = along ? along->direction[static_cast<std::size_t>(c)] : (c == prescribed[i].component ? 1.0 : 0.0);
        if (part != 0) assembly.add({copy.subdomain, row, copy.node * dimension + c, part * copy.weight / factor});
      }
    owned.push_back(row);
    scale.push_back(factor);
  }
  const std::size_t means_at = owned.size();
  for (std::size_t m = 0; m < mean_motions.size(); ++m)
    owned.push_back(dirichlet_base + dirichlet_numbers.start + static_cast<Global>(prescribed.size() + skew_supports.size() + m));
  ranges_.springs = static_cast<Local>(owned.size());
  for (std::size_t i = 0; i < springs.own.size(); ++i)
    owned.push_back(dirichlet_base + dirichlet_numbers.start +
                    static_cast<Global>(prescribed.size() + skew_supports.size() + mean_motions.size() + i));
  ranges_.contacts = static_cast<Local>(owned.size());

  nodes.clear();
  for (const auto& entry : contacts.rows.entries) nodes.push_back(entry.node);
  for (const auto& mean : mean_motions)
    for (const auto& entry : mean.entries) nodes.push_back(entry.node);
  for (const std::size_t i : springs.own)
    for (const auto& entry : springs.rows[i].entries) nodes.push_back(entry.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto contact_copies = directory.find(nodes, comm);
  const auto copies_of = [&](Global node) {
    return contact_copies[static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin())];
  };
  // What makes a row a unit vector in D^-1, the copies' averages taken together.
  const auto unit_factor = [&](std::span<const constraint::Entry> entries, double compliance = 0) {
    double square = compliance;
    for (const auto& entry : entries) square += entry.coefficient * entry.coefficient / total_weight(copies_of(entry.node));
    return 1 / std::sqrt(square);
  };
  const auto add_entries = [&](std::span<const constraint::Entry> entries, Global row, double factor) {
    for (const auto& entry : entries) {
      const auto copies = copies_of(entry.node);
      const double share = factor * entry.coefficient / total_weight(copies);
      for (const auto& copy : copies)
        assembly.add({copy.subdomain, row, copy.node * dimension + entry.component, share * copy.weight});
    }
  };
  for (std::size_t m = 0; m < mean_motions.size(); ++m) {
    scale.push_back(unit_factor(mean_motions[m].entries));
    add_entries(mean_motions[m].entries, owned[means_at + m], scale.back());
  }
  for (std::size_t i = 0; i < springs.own.size(); ++i) {  // a unit vector in D^-1 plus the compliance
    const auto row = springs.own[i];
    const auto diagonal = springs.stiffness.coeff(static_cast<int>(row), static_cast<int>(row));
    scale.push_back(unit_factor(springs.rows[row].entries, 1 / diagonal));
    add_entries(springs.rows[row].entries, owned[static_cast<std::size_t>(ranges_.springs) + i], scale.back());
  }
  for (const auto& point : contacts.nodes) {
    const double factor = unit_factor(contacts.rows[point.row]);
    for (std::size_t r = point.row; r <= point.row + point.tangents.size(); ++r) {
      const Global row = contact_base + contact_numbers.start + static_cast<Global>(r);
      add_entries(contacts.rows[r], row, factor);
      owned.push_back(row);
      scale.push_back(factor);
    }
  }
  ranges_.extra = static_cast<Local>(owned.size());

  for (std::size_t e = 0; e < extra.size(); ++e) {
    const Global row = extra_base + static_cast<Global>(e);
    Global lowest = decomposition.subdomain_count();
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const auto& coefficients = extra[e].coefficients[s];
      if (coefficients.size() == 0) continue;
      lowest = std::min(lowest, decomposition.subdomains[s].id);
      for (Local i = 0; i < coefficients.size(); ++i)
        assembly.add_local({decomposition.subdomains[s].id, row, i, coefficients[i]});
    }
    if (decomposition.rank_of(comm.min(lowest)) == comm.rank()) {
      owned.push_back(row);
      scale.push_back(1);
    }
  }
  ranges_.end = static_cast<Local>(owned.size());
  scale_ = Eigen::Map<const Eigen::VectorXd>(scale.data(), static_cast<Eigen::Index>(scale.size()));
  update_rhs(prescribed, skew_supports, contacts, mean_motions);

  // The rows that this rank's subdomains take part in, and their blocks.
  const auto pieces = assembly.receive();
  std::vector<Global> touched;
  for (const auto& piece : pieces) touched.push_back(piece.row);
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto teuchos_comm = teuchos(comm);
  rows_ = Teuchos::rcp(new Map(
      invalid, Teuchos::ArrayView<const Global>(owned.data(), static_cast<Teuchos::Ordinal>(owned.size())), 0, teuchos_comm));
  overlap_ = Teuchos::rcp(new Map(
      invalid, Teuchos::ArrayView<const Global>(touched.data(), static_cast<Teuchos::Ordinal>(touched.size())), 0, teuchos_comm));
  import_ = Teuchos::rcp(new Import(rows_, overlap_));

  auto piece = pieces.begin();
  for (const auto& subdomain : decomposition.subdomains) {
    Block block;
    block.size = static_cast<int>(subdomain.mesh.node_count()) * dimension;
    for (; piece != pieces.end() && piece->subdomain == subdomain.id; ++piece) {
      const Local row = overlap_->getLocalElement(piece->row);
      if (block.row.empty() || block.row.back() != row) {
        block.row.push_back(row);
        block.offset.push_back(block.unknown.size());
      }
      block.unknown.push_back(piece->unknown);
      block.coefficient.push_back(piece->coefficient);
      block.offset.back() = block.unknown.size();
    }
    blocks_.push_back(std::move(block));
  }
}

void JumpOperator::update_rhs(std::span<const constraint::PrescribedDof> prescribed,
                              std::span<const constraint::SkewSupport> skew_supports, const constraint::Contacts& contacts,
                              std::span<const constraint::MeanMotion> mean_motions)
{
  bound_ = Eigen::VectorXd::Zero(ranges_.end);
  Local row = ranges_.dirichlet;
  for (const auto& h : prescribed) bound_[row++] = h.value;
  for (const auto& i : skew_supports) bound_[row++] = i.value;
  for (const auto& mean : mean_motions) bound_[row++] = mean.value;
  for (std::size_t r = 0; r < contacts.rows.size(); ++r)
    bound_[ranges_.contacts + static_cast<Local>(r)] = contacts.rows.bound[r];
  bound_.array() *= scale_.array();
}

std::vector<Eigen::VectorXd> JumpOperator::apply_transpose(const Vector& lambda) const
{
  Vector overlapping(overlap_);
  overlapping.doImport(lambda, *import_, Tpetra::INSERT);
  const auto values = view(std::as_const(overlapping));
  std::vector<Eigen::VectorXd> forces;
  for (const auto& block : blocks_) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(block.size);
    for (std::size_t r = 0; r < block.row.size(); ++r)
      for (std::size_t i = block.offset[r]; i < block.offset[r + 1]; ++i)
        force[block.unknown[i]] += block.coefficient[i] * values[block.row[r]];
    forces.push_back(std::move(force));
  }
  return forces;
}

Vector JumpOperator::apply(const std::vector<Eigen::VectorXd>& u) const
{
  Vector overlapping(overlap_);
  {
    auto values = view(overlapping);
    for (std::size_t s = 0; s < blocks_.size(); ++s)
      for (std::size_t r = 0; r < blocks_[s].row.size(); ++r)
        for (std::size_t i = blocks_[s].offset[r]; i < blocks_[s].offset[r + 1]; ++i)
          values[blocks_[s].row[r]] += blocks_[s].coefficient[i] * u[s][blocks_[s].unknown[i]];
  }
  Vector jumps(rows_);
  jumps.doExport(overlapping, *import_, Tpetra::ADD);
  return jumps;
}

SparseMatrix JumpOperator::gather_columns(const std::vector<Columns>& parts, int height, const Communicator& comm) const
{
  struct Sent {
    Global row;
    int index;
    double value;
  };
  const auto touched = overlap_->getNodeElementList();
  std::vector<int> rank(static_cast<std::size_t>(touched.size()));
  rows_->getRemoteIndexList(touched, Teuchos::ArrayView<int>(rank.data(), touched.size()));
  std::vector<Local> owned(rank.size());  // where row of the overlapping map stands here
  for (std::size_t r = 0; r < rank.size(); ++r) owned[r] = rows_->getLocalElement(touched[static_cast<Teuchos::Ordinal>(r)]);
  std::vector<std::vector<Sent>> send(static_cast<std::size_t>(comm.size()));
  const auto for_each_part = [&](const auto& visit) {
    for (const auto& part : parts)
      for (std::size_t r = 0; r < part.row.size(); ++r)
        visit(static_cast<std::size_t>(part.row[r]), part.first, part.values.col(static_cast<Eigen::Index>(r)));
  };
  for_each_part([&](std::size_t row, int start, const auto& column) {
    if (rank[row] == comm.rank()) return;
    for (int i = 0; i < column.size(); ++i)
      send[static_cast<std::size_t>(rank[row])].push_back({touched[static_cast<Teuchos::Ordinal>(row)], start + i, column[i]});
  });
  const auto received = comm.exchange(send);

  // Compressed columns, without a list of triplets: G is the largest matrix of the dual space.
  const auto width = static_cast<Eigen::Index>(rows_->getNodeNumElements());
  Eigen::VectorXi count = Eigen::VectorXi::Zero(width);
  for_each_part([&](std::size_t row, int, const auto& column) {
    if (rank[row] == comm.rank()) count[owned[row]] += static_cast<int>(column.size());
  });
  for (const auto& part : received)
    for (const auto& entry : part) ++count[rows_->getLocalElement(entry.row)];
  SparseMatrix result(height, width);
  result.reserve(count);
  for_each_part([&](std::size_t row, int start, const auto& column) {
    if (rank[row] != comm.rank()) return;
    for (int i = 0; i < column.size(); ++i) result.insert(start + i, owned[row]) = column[i];
  });
  for (const auto& part : received)
    for (const auto& entry : part) result.insert(entry.index, rows_->getLocalElement(entry.row)) = entry.value;
  result.makeCompressed();
  return result;
}

Vector JumpOperator::multipliers(const Eigen::VectorXd& forces) const
{
  Vector lambda(rows_);
  view(lambda) = forces.cwiseQuotient(scale_);
  return lambda;
}

Eigen::VectorXd JumpOperator::jumps(const std::vector<Eigen::VectorXd>& u) const
{
  const Vector scaled = apply(u);
  return view(scaled).cwiseQuotient(scale_);
}

}  // namespace mortise::feti
