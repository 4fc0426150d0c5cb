#include "feti/jump_operator.hpp"

#include <algorithm>

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

Eigen::VectorXd JumpOperator::bound(const constraint::Constraints& constraints) const
{
  Eigen::VectorXd bound = Eigen::VectorXd::Zero(ranges_.end);
  Local row = ranges_.dirichlet;
  for (const auto& h : constraints.prescribed) bound[row++] = h.value;
  for (const auto& i : constraints.skew_supports) bound[row++] = i.value;
  for (const auto& mean : constraints.mean_motions) bound[row++] = mean.value;
  const auto& rows = constraints.contacts.rows;
  for (std::size_t r = 0; r < rows.size(); ++r) bound[ranges_.contacts + static_cast<Local>(r)] = rows.bound[r];
  bound.array() *= scaling_.array();
  return bound;
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
      if (column[i] != 0)
        send[static_cast<std::size_t>(rank[row])].push_back({touched[static_cast<Teuchos::Ordinal>(row)], start + i, column[i]});
  });
  const auto received = comm.exchange(send);

  // Compressed columns, without a list of triplets: G is the largest matrix of the dual space.
  const auto width = static_cast<Eigen::Index>(rows_->getNodeNumElements());
  Eigen::VectorXi count = Eigen::VectorXi::Zero(width);
  for_each_part([&](std::size_t row, int, const auto& column) {
    if (rank[row] == comm.rank()) count[owned[row]] += static_cast<int>((column.array() != 0).count());
  });
  for (const auto& part : received)
    for (const auto& entry : part) ++count[rows_->getLocalElement(entry.row)];
  SparseMatrix result(height, width);
  if (width == 0) return result;  // a rank without rows: Eigen's makeCompressed() writes beyond no columns
  result.reserve(count);
  for_each_part([&](std::size_t row, int start, const auto& column) {
    if (rank[row] != comm.rank()) return;
    for (int i = 0; i < column.size(); ++i)
      if (column[i] != 0) result.insert(start + i, owned[row]) = column[i];
  });
  for (const auto& part : received)
    for (const auto& entry : part) result.insert(entry.index, rows_->getLocalElement(entry.row)) = entry.value;
  result.makeCompressed();
  return result;
}

}  // namespace mortise::feti
