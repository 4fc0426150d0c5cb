#include "feti/preconditioner.hpp"

#include <algorithm>
#include <map>

#include "partition/node_directory.hpp"

namespace mortise::feti {

namespace {

// Entries of the symmetric matrix `lower` with place[row] >= 0 and place_column[column] >= 0, renumbered.
SparseMatrix extract(const SparseMatrix& lower, const std::vector<int>& row, int rows, const std::vector<int>& column,
                     int columns, bool only_lower)
{
  std::vector<Eigen::Triplet<double>> triplets;
  const auto add = [&](Eigen::Index i, Eigen::Index j, double value) {
    const int a = row[static_cast<std::size_t>(i)], b = column[static_cast<std::size_t>(j)];
    if (a >= 0 && b >= 0 && (!only_lower || a >= b)) triplets.emplace_back(a, b, value);
  };
  for (int j = 0; j < lower.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(lower, j); it; ++it) {
      add(it.row(), j, it.value());
      if (!only_lower && it.row() != j) add(j, it.row(), it.value());
    }
  SparseMatrix result(rows, columns);
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

}  // namespace

Preconditioner::Preconditioner(Kind kind, const partition::Decomposition& decomposition, const JumpOperator& jump,
                               const Subdomains& subdomains, const std::vector<std::vector<double>>& nodal_stiffness,
                               const std::string& factorization, Timers& timers)
    : jump_(jump), timers_(timers)
{
  const int dimension = decomposition.catalogue.dimension;
  std::map<const SubdomainOperator*, std::shared_ptr<const Surface>> made;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    if (const auto known = made.find(subdomains[s].get()); known != made.end()) {
      surfaces_.push_back(known->second);
      continue;
    }
    const SparseMatrix& stiffness = subdomains[s]->stiffness();
    Surface surface;
    std::vector<int> outside(static_cast<std::size_t>(stiffness.rows()), -1), inside(outside);
    for (const Local node : partition::surface_nodes(decomposition.subdomains[s].mesh))
      for (int c = 0; c < dimension; ++c) {
        const int unknown = dimension * node + c;
        outside[static_cast<std::size_t>(unknown)] = static_cast<int>(surface.unknowns.size());
        surface.unknowns.push_back(unknown);
      }
    const auto size = static_cast<int>(surface.unknowns.size());
    surface.weight.resize(size);
    for (int i = 0; i < size; ++i)
      surface.weight[i] =
          1 / nodal_stiffness[s][static_cast<std::size_t>(surface.unknowns[static_cast<std::size_t>(i)] / dimension)];
    surface.lower = extract(stiffness, outside, size, outside, size, true);
    if (kind == Kind::dirichlet) {
      int interior = 0;
      for (std::size_t i = 0; i < inside.size(); ++i)
        if (outside[i] < 0) inside[i] = interior++;
      if (interior > 0) {
        surface.interior =
            std::make_unique<DirectSolver>(factorization, extract(stiffness, inside, interior, inside, interior, true));
        surface.coupling = extract(stiffness, inside, interior, outside, size, false);
      }
    }
    surfaces_.push_back(std::make_shared<const Surface>(std::move(surface)));
    made.emplace(subdomains[s].get(), surfaces_.back());
  }
}

void Preconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  const auto scope = timers_.scope("preconditioner");
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto in = x.getVector(column);
    auto forces = jump_.apply_transpose(*in);
    std::map<const Surface*, std::vector<std::size_t>> members;
    for (std::size_t s = 0; s < forces.size(); ++s) members[surfaces_[s].get()].push_back(s);
    for (const auto& [surface, list] : members)
      for (std::size_t first = 0; first < list.size(); first += block_columns) {
        const auto count = static_cast<Eigen::Index>(std::min(block_columns, list.size() - first));
        Eigen::MatrixXd u(surface->weight.size(), count);
        for (Eigen::Index c = 0; c < count; ++c)
          u.col(c) = forces[list[first + static_cast<std::size_t>(c)]](surface->unknowns).cwiseProduct(surface->weight);
        Eigen::MatrixXd f = surface->lower.selfadjointView<Eigen::Lower>() * u;
        if (surface->interior) {
          Eigen::MatrixXd inner = surface->coupling * u;
          surface->interior->solve(inner.data(), inner.data(), static_cast<int>(count));
          f -= surface->coupling.transpose() * inner;
        }
        for (Eigen::Index c = 0; c < count; ++c) {
          auto& force = forces[list[first + static_cast<std::size_t>(c)]];
          force.setZero();
          force(surface->unknowns) = f.col(c).cwiseProduct(surface->weight);
        }
      }
    Vector result = jump_.apply(forces);
    const auto extra = jump_.ranges().end - jump_.ranges().extra;
    view(result).segment(jump_.ranges().extra, extra) = view(*in).segment(jump_.ranges().extra, extra);
    y.getVectorNonConst(column)->update(alpha, result, beta);
  }
}

}  // namespace mortise::feti
