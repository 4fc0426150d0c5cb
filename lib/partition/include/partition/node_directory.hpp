// Where a node lives: the subdomains that hold a copy of it, over all ranks. Only nodes on the surface of a subdomain (on a cell
// face that no second cell of the same subdomain shares) have entries; no other node can be shared, loaded by a neighbour or
// touched.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "partition/decomposition.hpp"

namespace mortise::partition {

/// One copy of a node.
struct Copy {
  Global subdomain;
  Local node;     ///< in that subdomain's mesh
  double weight;  ///< whatever the owner attached to the copy, such as the diagonal of its stiffness
};

/// A distributed table from global node to copies. The entries of a node stand on rank node_id % ranks.
class NodeDirectory {
 public:
  /// weight[s][n]: attached to local node n of this rank's s-th subdomain (all nodes; only those on the surface are kept).
  /// Collective.
  NodeDirectory(const Decomposition& decomposition, const std::vector<std::vector<double>>& weight, const Communicator& comm);

  /// Copies of several nodes, in compressed rows: those of the i-th node are copies[offset[i] .. offset[i+1]).
  struct Found {
    std::vector<std::size_t> offset;
    std::vector<Copy> copies;
    std::span<const Copy> operator[](std::size_t i) const
    {
      return std::span(copies).subspan(offset[i], offset[i + 1] - offset[i]);
    }
  };
  /// The copies of each of `nodes`, ascending by subdomain; none for a node that has no entry. Collective.
  Found find(std::span<const Global> nodes, const Communicator& comm) const;
  /// surface_nodes() of this rank's s-th subdomain.
  const std::vector<Local>& surface(std::size_t s) const { return surface_[s]; }

 private:
  std::vector<std::vector<Local>> surface_;
  std::vector<Global> nodes_;  ///< ascending
  Found entries_;
};

/// The local nodes on the surface of a subdomain, ascending; all of a skin.
std::vector<Local> surface_nodes(const Subdomain& subdomain);

/// The nodes of this rank's subdomains that have two copies or more, and where these are.
struct Interface {
  std::vector<std::vector<Local>> nodes;     ///< for each local subdomain, ascending
  std::vector<NodeDirectory::Found> copies;  ///< for each local subdomain, for each of its `nodes`
};
/// The interface of this rank's subdomains. Collective.
Interface find_interface(const Decomposition& decomposition, const NodeDirectory& directory, const Communicator& comm);

/// Adds up the rows of the copies of a node: afterwards every copy of a node has in its row the sum over all copies. The sum is
/// taken in the order of subdomains, so it is bitwise the same on every copy and for every number of ranks.
/// values[s]: nodes of subdomain s x components (the same number of components everywhere). Collective.
void sum_over_copies(const Decomposition& decomposition, const Interface& interface, std::vector<Eigen::MatrixXd>& values,
                     const Communicator& comm);

/// A row of values of a node, wherever it stands.
using NodeRow = Eigen::Map<Eigen::RowVectorXd, 0, Eigen::InnerStride<>>;
inline NodeRow row_of(Eigen::MatrixXd& values, Local node)
{
  return {values.data() + node, values.cols(), Eigen::InnerStride<>(values.outerStride())};
}
/// The row that stands in a column.
inline NodeRow column_of(Eigen::MatrixXd& values, Local column)
{
  return {values.col(column).data(), values.rows(), Eigen::InnerStride<>(1)};
}
inline NodeRow no_row()
{
  return {nullptr, 0, Eigen::InnerStride<>(1)};
}
/// The row of node n of local subdomain s; no_row() where that subdomain has none of this node.
using RowOfNode = std::function<NodeRow(std::size_t s, Local n)>;
/// The same of rows of `width` columns, the same everywhere, which are asked for at shared nodes alone. Collective.
void sum_rows(const Decomposition& decomposition, const Interface& interface, Eigen::Index width, const RowOfNode& row_at,
              const Communicator& comm);

}  // namespace mortise::partition
