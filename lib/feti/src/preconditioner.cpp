#include "feti/preconditioner.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "base/submatrix.hpp"
#include "partition/node_directory.hpp"

namespace mortise::feti {

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
    for (const Local node : partition::surface_nodes(decomposition.subdomains[s].mesh))
      for (int c = 0; c < dimension; ++c) surface.unknowns.push_back(dimension * node + c);
    const auto size = static_cast<int>(surface.unknowns.size());
    surface.weight.resize(size);
    for (int i = 0; i < size; ++i)
      surface.weight[i] =
          1 / nodal_stiffness[s][static_cast<std::size_t>(surface.unknowns[static_cast<std::size_t>(i)] / dimension)];
    surface.lower = submatrix(stiffness, surface.unknowns, surface.unknowns, true);
    if (kind == Kind::dirichlet) {
      std::vector<int> all(static_cast<std::size_t>(stiffness.rows())), inside;
      std::iota(all.begin(), all.end(), 0);
      std::set_difference(all.begin(), all.end(), surface.unknowns.begin(), surface.unknowns.end(), std::back_inserter(inside));
      if (!inside.empty()) {
        surface.interior = std::make_unique<DirectSolver>(factorization, submatrix(stiffness, inside, inside, true), dimension);
        surface.coupling = submatrix(stiffness, inside, surface.unknowns, false);
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
