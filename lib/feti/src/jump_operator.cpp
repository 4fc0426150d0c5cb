#include "feti/jump_operator.hpp"

#include <Tpetra_Import_Util.hpp>
#include <algorithm>

#include "base/packed.hpp"
#include "row_builder.hpp"

namespace mortise::feti {

namespace {

constexpr double compliance_of_node = 1;  // where the stiffness of a node is 1

// All nodes that rows with several entries act on.
std::vector<Global> nodes_of(const constraint::Contacts& contacts, std::span<const constraint::MeanMotion> mean_motions,
                             const constraint::Springs& springs)
{
  std::vector<Global> nodes;
  for (const auto& entry : contacts.rows.entries) nodes.push_back(entry.node);
  for (const auto& mean : mean_motions)
    for (const auto& entry : mean.entries) nodes.push_back(entry.node);
  for (const std::size_t row : springs.own)
    for (const auto& entry : springs.rows[row].entries) nodes.push_back(entry.node);
  return nodes;
}

// The different rows of the pieces, ascending.
std::vector<Global> rows_of(const std::vector<Piece>& pieces)
{
  std::vector<Global> rows;
  for (const auto& piece : pieces) rows.push_back(piece.row);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

Teuchos::RCP<const Map> map_of(const std::vector<Global>& rows, const Communicator& comm)
{
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return Teuchos::rcp(new Map(invalid, Teuchos::ArrayView<const Global>(rows.data(), static_cast<Teuchos::Ordinal>(rows.size())),
                              0, teuchos(comm)));
}

// Entries of a sparse matrix on their way: row, column, value.
struct EntriesOfRows {
  std::vector<Global> row, index;
  std::vector<double> value;
};

// send[r] goes to rank r; returns what came from each rank. Collective.
std::vector<EntriesOfRows> exchange_entries(const std::vector<EntriesOfRows>& send, const Communicator& comm)
{
  std::vector<std::vector<char>> messages;
  for (const auto& to : send) {
    PackedWriter writer;
    if (!to.row.empty()) {
      writer.integers(to.row);
      writer.integers(to.index);
      writer.numbers(to.value);
    }
    messages.push_back(writer.take());
  }
  std::vector<EntriesOfRows> received;
  for (const auto& message : comm.exchange(messages)) {
    auto& from = received.emplace_back();
    if (message.empty()) continue;
    PackedReader reader(message);
    from = {reader.integers(), reader.integers(), reader.numbers()};
  }
  return received;
}

// Moves on from `piece` over those of one subdomain. `rows`: the overlapping map.
JumpOperator::Block block_of(const partition::Subdomain& subdomain, int dimension, std::vector<Piece>::const_iterator& piece,
                             std::vector<Piece>::const_iterator end, const Map& rows)
{
  JumpOperator::Block block;
  block.size = static_cast<int>(subdomain.mesh.node_count()) * dimension;
  for (; piece != end && piece->subdomain == subdomain.id; ++piece) {
    const Local row = rows.getLocalElement(piece->row);
    if (block.row.empty() || block.row.back() != row) {
      block.row.push_back(row);
      block.offset.push_back(block.unknown.size());
    }
    block.unknown.push_back(piece->unknown);
    block.coefficient.push_back(piece->coefficient);
    block.offset.back() = block.unknown.size();
  }
  return block;
}

}  // namespace

JumpOperator::JumpOperator(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
                           const partition::Interface& interface, std::span<const constraint::PrescribedDof> prescribed,
                           std::span<const constraint::SkewSupport> skew_supports, const constraint::Contacts& contacts,
                           const Communicator& comm, std::span<const constraint::MeanMotion> mean_motions,
                           const constraint::Springs& springs)
    : JumpOperator(decomposition, directory, interface, prescribed, skew_supports, contacts, std::span<const SubdomainRow>(),
                   comm, mean_motions, springs)
{
}

JumpOperator::JumpOperator(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
                           const partition::Interface& interface, std::span<const constraint::PrescribedDof> prescribed,
                           std::span<const constraint::SkewSupport> skew_supports, const constraint::Contacts& contacts,
                           std::span<const SubdomainRow> extra, const Communicator& comm,
                           std::span<const constraint::MeanMotion> mean_motions, const constraint::Springs& springs)
{
  RowBuilder rows(decomposition, directory, comm);
  rows.glue(interface);
  ranges_.dirichlet = rows.size();
  rows.begin(prescribed.size() + skew_supports.size() + mean_motions.size() + springs.own.size());
  rows.add(prescribed, skew_supports);
  rows.find_copies(nodes_of(contacts, mean_motions, springs));
  rows.add(mean_motions);
  ranges_.springs = rows.size();
  rows.add(springs);
  ranges_.contacts = rows.size();
  contact_rows_.first = rows.end();
  rows.begin(contacts.rows.size());
  rows.add(contacts);
  ranges_.extra = rows.size();
  contact_rows_.second = rows.end();
  rows.add(extra);
  ranges_.end = rows.size();
  scaling_ = Eigen::Map<const Eigen::VectorXd>(rows.scale().data(), ranges_.end);
  compliance_ = Eigen::VectorXd::Zero(ranges_.end);
  for (const auto& node : contacts.nodes)
    for (std::size_t r = node.row; r <= node.row + node.tangents.size(); ++r)
      if (!node.parts.empty() || contacts.rows[r].empty())
        compliance_[ranges_.contacts + static_cast<Local>(r)] = compliance_of_node;

  const auto pieces = rows.receive();
  rows_ = map_of(rows.owned(), comm);
  overlap_ = map_of(rows_of(pieces), comm);  // the rows that this rank's subdomains take part in
  import_ = Teuchos::rcp(new Import(rows_, overlap_));
  auto piece = pieces.begin();
  for (const auto& subdomain : decomposition.subdomains)
    blocks_.push_back(block_of(subdomain, decomposition.catalogue.dimension, piece, pieces.end(), *overlap_));
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
  const auto touched = overlap_->getNodeElementList();
  Teuchos::Array<int> rank;  // that owns each of these rows
  Tpetra::Import_Util::getPids(*import_, rank, false);
  std::vector<Local> owned;  // where they stand here
  for (const Global row : touched) owned.push_back(rows_->getLocalElement(row));
  std::vector<EntriesOfRows> send(static_cast<std::size_t>(comm.size()));
  const auto for_each_part = [&](const auto& visit) {
    for (const auto& part : parts)
      for (std::size_t r = 0; r < part.row.size(); ++r)
        visit(part.row[r], part.first, part.values.col(static_cast<Eigen::Index>(r)));
  };
  for_each_part([&](Local row, int start, const auto& column) {
    if (rank[row] == comm.rank()) return;
    auto& to = send[static_cast<std::size_t>(rank[row])];
    for (int i = 0; i < column.size(); ++i) {
      if (column[i] == 0) continue;
      to.row.push_back(touched[row]);
      to.index.push_back(start + i);
      to.value.push_back(column[i]);
    }
  });
  const auto received = exchange_entries(send, comm);

  // Compressed columns, without a list of triplets: G is the largest matrix of the dual space.
  const auto width = static_cast<Eigen::Index>(rows_->getNodeNumElements());
  Eigen::VectorXi count = Eigen::VectorXi::Zero(width);
  const auto here = [&](Local row) { return owned[static_cast<std::size_t>(row)]; };
  for_each_part([&](Local row, int, const auto& column) {
    if (rank[row] == comm.rank()) count[here(row)] += static_cast<int>((column.array() != 0).count());
  });
  for (const auto& part : received)
    for (const Global row : part.row) ++count[rows_->getLocalElement(row)];
  SparseMatrix result(height, width);
  if (width == 0) return result;  // a rank without rows: Eigen's makeCompressed() writes beyond no columns
  result.reserve(count);
  for_each_part([&](Local row, int start, const auto& column) {
    if (rank[row] != comm.rank()) return;
    for (int i = 0; i < column.size(); ++i)
      if (column[i] != 0) result.insert(start + i, here(row)) = column[i];
  });
  for (const auto& part : received)
    for (std::size_t i = 0; i < part.row.size(); ++i)
      result.insert(part.index[i], rows_->getLocalElement(part.row[i])) = part.value[i];
  result.makeCompressed();
  return result;
}

}  // namespace mortise::feti
