// B: the jump operator from the displacements of all subdomains to the dual space, and the scaling of its rows.
//
// Gluing rows of a node with copies of stiffness w_1 .. w_m: row k = 1 .. m-1 (and component) has the coefficients a w_q at
// copies q < k and -a (w_1 + .. + w_k) at the copy after them, which makes the rows orthonormal in the inner product of D^-1, D =
// diag(w). Supports and contacts act on the average of the copies with weights w_q / sum w, and are therefore D^-1-orthogonal to
// the gluing rows. Each such row is multiplied by a factor that makes it a unit vector in D^-1 as well (one factor for
// all rows of a contact node, so that discs stay discs). This keeps the dual operator well conditioned when the stiffness jumps
// by 1e6.
#pragma once

#include <vector>

#include "base/cholesky.hpp"
#include "base/tpetra.hpp"
#include "constraint/constraints.hpp"
#include "partition/decomposition.hpp"
#include "partition/node_directory.hpp"

namespace mortise::feti {

struct SubdomainRow;  // of this module alone, as what follows
struct RowScaling;

/// Heavy: moves, does not copy.
class JumpOperator {
 public:
  /// `prescribed`, `skew_supports`, `mean_motions`, `springs` and `contacts`: this rank's rows. Owned rows are numbered on each
  /// rank: gluing, Dirichlet (prescribed components, skew supports, mean motions), springs, contacts, extra. Collective.
  JumpOperator(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
               const partition::Interface& interface, std::span<const constraint::PrescribedDof> prescribed,
               std::span<const constraint::SkewSupport> skew_supports, const constraint::Contacts& contacts,
               const Communicator& comm, std::span<const constraint::MeanMotion> mean_motions = {},
               const constraint::Springs& springs = {});
  /// With these extra rows, the same on all ranks. Collective.
  JumpOperator(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
               const partition::Interface& interface, std::span<const constraint::PrescribedDof> prescribed,
               std::span<const constraint::SkewSupport> skew_supports, const constraint::Contacts& contacts,
               std::span<const SubdomainRow> extra, const Communicator& comm,
               std::span<const constraint::MeanMotion> mean_motions, const constraint::Springs& springs);

  /// The dual space: each row on one rank.
  Teuchos::RCP<const Map> rows() const { return rows_; }
  /// First owned local index of each kind; kinds are contiguous.
  struct Ranges {
    Local gluing = 0, dirichlet = 0, springs = 0, contacts = 0, extra = 0, end = 0;
  };
  const Ranges& ranges() const { return ranges_; }
  /// Global numbers of the contact rows of all ranks: first, and one past the last.
  std::pair<Global, Global> contact_rows() const { return contact_rows_; }

  /// f_s = B_s' lambda for each subdomain of this rank. Collective.
  std::vector<Eigen::VectorXd> apply_transpose(const Vector& lambda) const;
  /// B u. Collective.
  Vector apply(const std::vector<Eigen::VectorXd>& u) const;

  /// B over one subdomain in compressed rows: the rows, as local indices of the overlapping map, that it takes part in.
  struct Block {
    int size = 0;  ///< unknowns of the subdomain
    std::vector<Local> row;
    std::vector<std::size_t> offset{0};
    std::vector<Local> unknown;
    std::vector<double> coefficient;
  };
  /// Of each subdomain of this rank.
  const std::vector<Block>& blocks() const { return blocks_; }
  /// The overlapping map: the rows that this rank's subdomains take part in, whoever owns them.
  Teuchos::RCP<const Map> touched_rows() const { return overlap_; }
  const Import& import() const { return *import_; }  ///< from rows() to touched_rows()

  /// Dense parts of columns of a matrix over the dual space: column r of `values`, r < row.size(), is the part of column row[r],
  /// a local index of the overlapping map, from the matrix' row `first` on.
  struct Columns {
    int first = 0;
    std::vector<Local> row;
    Eigen::MatrixXd values;
  };
  /// The matrix of these parts, no two of which overlap: `height` x owned rows. Collective.
  SparseMatrix gather_columns(const std::vector<Columns>& parts, int height, const Communicator& comm) const;

 private:
  friend struct RowScaling;
  Teuchos::RCP<const Map> rows_;
  Teuchos::RCP<const Map> overlap_;
  Teuchos::RCP<const Import> import_;
  Ranges ranges_;
  std::pair<Global, Global> contact_rows_;
  Eigen::VectorXd scaling_;
  Eigen::VectorXd compliance_;
  std::vector<Block> blocks_;
};

}  // namespace mortise::feti
