// The rows of B one kind after the other: numbers, scales, and coefficients on the ranks of their subdomains.
#pragma once

#include <vector>

#include "feti/jump_operator.hpp"

namespace mortise::feti {

// One coefficient of B.
struct Piece {
  Global subdomain;
  Global row;
  Local unknown;
  double coefficient;
};

// Gives rows their numbers, one kind after the other. Collective throughout, but for sizes.
class RowBuilder {
 public:
  // Its arguments outlive it.
  RowBuilder(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory, const Communicator& comm);

  // Rows that are orthonormal in D^-1, each on the rank of the first copy of its node.
  void glue(const partition::Interface& interface);
  // The next `count` rows of this rank are numbered one after the other, after those of all ranks that are there.
  void begin(std::size_t count);
  // Rows that act on components, or along directions, of single nodes.
  void add(std::span<const constraint::PrescribedDof> prescribed, std::span<const constraint::SkewSupport> skew_supports);
  // Those that are to come act on these nodes.
  void find_copies(std::vector<Global> nodes);
  void add(std::span<const constraint::MeanMotion> means);
  void add(const constraint::Springs& springs);
  // Those of a node have one factor, that of the first of them.
  void add(const constraint::Contacts& contacts);
  // The same rows on all ranks; that of the lowest subdomain with a coefficient owns one.
  void add(std::span<const SubdomainRow> rows);

  Local size() const { return static_cast<Local>(owned_.size()); }  // rows of this rank
  Global end() const { return end_; }                               // rows of all ranks
  const std::vector<Global>& owned() const { return owned_; }
  const std::vector<double>& scale() const { return scale_; }  // of each, see RowScaling
  // Pieces of this rank's subdomains, ordered by subdomain, row and unknown. Once.
  std::vector<Piece> receive();

 private:
  void own(Global row, double scale);
  void send(const Piece& piece);
  void send(std::span<const constraint::Entry> entries, Global row, double factor);
  std::span<const partition::Copy> copies_of(Global node) const;
  double unit_factor(std::span<const constraint::Entry> entries, double compliance = 0) const;

  const partition::Decomposition& decomposition_;
  const partition::NodeDirectory& directory_;
  const Communicator& comm_;
  const int dimension_;
  Global next_ = 0, end_ = 0;
  std::vector<Global> owned_;
  std::vector<double> scale_;
  std::vector<std::vector<Piece>> send_;  // to each rank
  std::vector<Global> nodes_;             // sorted, with their copies
  partition::NodeDirectory::Found copies_;
};

}  // namespace mortise::feti
