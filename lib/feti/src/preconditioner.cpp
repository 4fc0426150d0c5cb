#include "feti/preconditioner.hpp"

#include <algorithm>
#include <numeric>

#include "base/submatrix.hpp"
#include "partition/node_directory.hpp"

namespace mortise::feti {

namespace {

constexpr std::size_t block_columns = 64;  // copies that go through one matrix together

}  // namespace

Preconditioner::Preconditioner(Kind kind, const partition::Decomposition& decomposition, const JumpOperator& jump,
                               const Subdomains& subdomains, const std::vector<std::vector<double>>& nodal_stiffness,
                               const std::string& factorization, Timers& timers)
    : jump_(jump), subdomains_(subdomains), timers_(timers)
{
  const int dimension = decomposition.catalogue.dimension;
  for (auto& [original, members] : by_original(subdomains)) {
    const std::size_t s = members.front();
    const SparseMatrix& stiffness = original->stiffness();
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
    groups_.push_back({std::move(surface), members});
  }
}

void Preconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  const auto scope = timers_.scope("preconditioner");
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto in = x.getVector(column);
    auto forces = jump_.apply_transpose(*in);
    for (const auto& [surface, members] : groups_)
      for (std::size_t first = 0; first < members.size(); first += block_columns) {
        const auto count = std::min(block_columns, members.size() - first);
        Eigen::MatrixXd u(surface.weight.size(), static_cast<Eigen::Index>(count));
        for (std::size_t c = 0; c < count; ++c) {
          const std::size_t s = members[first + c];
          subdomains_[s]->turn_back(forces[s]);
          u.col(static_cast<Eigen::Index>(c)) = forces[s](surface.unknowns).cwiseProduct(surface.weight);
        }
        Eigen::MatrixXd f = surface.lower.selfadjointView<Eigen::Lower>() * u;
        if (surface.interior) {
          Eigen::MatrixXd inner = surface.coupling * u;
          std::vector<double*> columns;
          for (Eigen::Index c = 0; c < inner.cols(); ++c) columns.push_back(inner.col(c).data());
          surface.interior->solve(columns);
          f -= surface.coupling.transpose() * inner;
        }
        for (std::size_t c = 0; c < count; ++c) {
          const std::size_t s = members[first + c];
          forces[s].setZero();
          forces[s](surface.unknowns) = f.col(static_cast<Eigen::Index>(c)).cwiseProduct(surface.weight);
          subdomains_[s]->turn(forces[s]);
        }
      }
    Vector result = jump_.apply(forces);
    const auto extra = jump_.ranges().end - jump_.ranges().extra;
    view(result).segment(jump_.ranges().extra, extra) = view(*in).segment(jump_.ranges().extra, extra);
    y.getVectorNonConst(column)->update(alpha, result, beta);
  }
}

}  // namespace mortise::feti
