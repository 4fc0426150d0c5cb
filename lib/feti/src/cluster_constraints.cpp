#include "cluster_constraints.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/topology.hpp"

namespace mortise::feti {

namespace {

constexpr double rounding_of_entry = 1e-12;  // of a row's largest entry, below which others count as 0, in all copies alike
constexpr double no_rank = 1e-10;            // of a motion's square, when those before it are taken out
constexpr double dependent = 1e-8;           // square of a row's distance from the rows before it
constexpr double trace = 1e-13;              // on the diagonal, so that dependent rows do not spoil those after them by rounding

// A node that two subdomains have in common: its number in both, and its weight.
struct Common {
  Local a, b;
  double weight;
  auto operator<=>(const Common&) const = default;
};

// By other subdomain of the cluster with a higher number, ids up to `last`: the nodes of the faces in common with the s-th.
std::map<Global, std::vector<Common>> common_nodes(const partition::Decomposition& decomposition,
                                                   const partition::Interface& interface, const std::vector<double>& weight,
                                                   std::size_t s, Global last)
{
  const auto& subdomain = decomposition.subdomains[s];
  const auto& cells = subdomain.mesh.cells;
  std::vector<int> place(subdomain.mesh.node_count(), -1);  // among the nodes of the interface
  for (std::size_t i = 0; i < interface.nodes[s].size(); ++i)
    place[static_cast<std::size_t>(interface.nodes[s][i])] = static_cast<int>(i);
  const auto copy_in = [&](Local node, Global other) -> const partition::Copy* {
    const int at = place[static_cast<std::size_t>(node)];
    if (at < 0) return nullptr;
    for (const auto& copy : interface.copies[s][static_cast<std::size_t>(at)])
      if (copy.subdomain == other) return &copy;
    return nullptr;
  };
  std::map<Global, std::vector<Common>> result;
  for (const auto& face : mesh::border_faces(cells)) {
    const int at = place[static_cast<std::size_t>(face.corners[0])];
    if (at < 0) continue;
    for (const auto& copy : interface.copies[s][static_cast<std::size_t>(at)]) {
      const Global other = copy.subdomain;
      if (other <= subdomain.id || other > last) continue;
      if (!std::all_of(face.corners.begin(), face.corners.end(), [&](Local n) { return n < 0 || copy_in(n, other); })) continue;
      const auto cell = static_cast<std::size_t>(face.cell);
      for (const int n : mesh::faces(cells.type[cell])[static_cast<std::size_t>(face.face)].nodes) {
        const Local node = cells[cell][static_cast<std::size_t>(n)];
        const auto* there = copy_in(node, other);
        if (!there) continue;
        const double here = weight[static_cast<std::size_t>(node)];
        result[other].push_back({node, there->node, here * there->weight / (here + there->weight)});
      }
    }
  }
  for (auto& [other, nodes] : result) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return result;
}

// Weighted rigid motions of some nodes, (dimension * nodes) x at most 6, as cluster_constraints() says.
Eigen::MatrixXd averages(const std::vector<Common>& nodes, const std::vector<Point>& points, fem::Kinematics kinematics)
{
  std::vector<Point> at;
  for (const auto& node : nodes) at.push_back(points[static_cast<std::size_t>(node.a)]);
  if (kinematics == fem::Kinematics::axisymmetric) kinematics = fem::Kinematics::plane_strain;
  Eigen::MatrixXd motions = fem::rigid_motions(at, kinematics);
  const int dimension = fem::dimension(kinematics);
  Eigen::VectorXd weight(motions.rows());
  for (Eigen::Index i = 0; i < weight.size(); ++i) weight[i] = nodes[static_cast<std::size_t>(i / dimension)].weight;
  const auto product = [&](Eigen::Index i, Eigen::Index j) { return motions.col(i).dot(weight.cwiseProduct(motions.col(j))); };
  Eigen::Index rank = 0;
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    const double before = product(k, k);
    for (int pass = 0; pass < 2; ++pass)
      for (Eigen::Index j = 0; j < rank; ++j) motions.col(k) -= product(j, k) * motions.col(j);
    const double left = product(k, k);
    if (left > no_rank * before) motions.col(rank++) = motions.col(k) / std::sqrt(left);
  }
  return weight.asDiagonal() * motions.leftCols(rank);
}

}  // namespace

std::vector<ClusterConstraint> cluster_constraints(const partition::Decomposition& decomposition,
                                                   const partition::Interface& interface,
                                                   const std::vector<std::vector<double>>& weight, fem::Kinematics kinematics,
                                                   std::size_t first, std::size_t end)
{
  const int dimension = fem::dimension(kinematics);
  const auto& subdomains = decomposition.subdomains;
  std::vector<ClusterConstraint> constraints(end - first);
  std::vector<std::vector<Eigen::Triplet<double>>> entries(end - first);
  int next = 0;
  for (std::size_t s = first; s < end; ++s)
    for (const auto& [other, nodes] : common_nodes(decomposition, interface, weight[s], s, subdomains[end - 1].id)) {
      const std::size_t a = s - first, b = static_cast<std::size_t>(other - subdomains[first].id);
      const Eigen::MatrixXd rows = averages(nodes, subdomains[s].mesh.points, kinematics);
      for (Eigen::Index k = 0; k < rows.cols(); ++k, ++next) {
        const double least = rounding_of_entry * rows.col(k).cwiseAbs().maxCoeff();
        for (Eigen::Index i = 0; i < rows.rows(); ++i) {
          if (std::abs(rows(i, k)) <= least) continue;
          const auto& node = nodes[static_cast<std::size_t>(i / dimension)];
          const auto component = static_cast<int>(i % dimension);
          entries[a].emplace_back(node.a * dimension + component, static_cast<int>(constraints[a].row.size()), rows(i, k));
          entries[b].emplace_back(node.b * dimension + component, static_cast<int>(constraints[b].row.size()), -rows(i, k));
        }
        constraints[a].row.push_back(next);
        constraints[b].row.push_back(next);
      }
    }
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    constraints[i].columns.resize(static_cast<Eigen::Index>(subdomains[first + i].mesh.node_count()) * dimension,
                                  static_cast<Eigen::Index>(constraints[i].row.size()));
    constraints[i].columns.setFromTriplets(entries[i].begin(), entries[i].end());
  }
  return constraints;
}

int drop_dependent(std::vector<ClusterConstraint>& constraints, const std::vector<std::vector<double>>& weight, int dimension,
                   std::size_t first)
{
  int count = 0;
  for (const auto& constraint : constraints)
    if (!constraint.row.empty()) count = std::max(count, constraint.row.back() + 1);
  // B0 D^-1 B0' = L diag(d) L': d is the square of each row's distance from those before it, in the order of elimination.
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    SparseMatrix scaled = constraints[i].columns;
    for (int r = 0; r < scaled.outerSize(); ++r)
      for (SparseMatrix::InnerIterator it(scaled, r); it; ++it)
        it.valueRef() /= weight[first + i][static_cast<std::size_t>(it.row() / dimension)];
    const SparseMatrix gram = constraints[i].columns.transpose() * scaled;
    for (int c = 0; c < gram.outerSize(); ++c)
      for (SparseMatrix::InnerIterator it(gram, c); it; ++it)
        entries.emplace_back(constraints[i].row[static_cast<std::size_t>(it.row())],
                             constraints[i].row[static_cast<std::size_t>(c)], it.value());
  }
  for (int r = 0; r < count; ++r) entries.emplace_back(r, r, trace);
  SparseMatrix gram(count, count);
  gram.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<SparseMatrix> factor(gram);
  const Eigen::VectorXd square = factor.permutationPinv() * Eigen::VectorXd(factor.vectorD());
  std::vector<int> number(static_cast<std::size_t>(count), -1);
  int left = 0;
  for (int r = 0; r < count; ++r)
    if (square[r] > dependent) number[static_cast<std::size_t>(r)] = left++;
  if (left == count) return count;
  for (auto& constraint : constraints) {
    std::vector<Eigen::Triplet<double>> kept;
    std::vector<int> row;
    for (std::size_t r = 0; r < constraint.row.size(); ++r) {
      if (number[static_cast<std::size_t>(constraint.row[r])] < 0) continue;
      for (SparseMatrix::InnerIterator it(constraint.columns, static_cast<int>(r)); it; ++it)
        kept.emplace_back(static_cast<int>(it.row()), static_cast<int>(row.size()), it.value());
      row.push_back(number[static_cast<std::size_t>(constraint.row[r])]);
    }
    SparseMatrix columns(constraint.columns.rows(), static_cast<Eigen::Index>(row.size()));
    columns.setFromTriplets(kept.begin(), kept.end());
    constraint = {std::move(columns), std::move(row)};
  }
  return left;
}

}  // namespace mortise::feti
