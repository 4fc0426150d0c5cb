#include "qp/sparse_newton.hpp"

#include <limits>

#include "base/error.hpp"
#include "sparse_system.hpp"
#include "state_search.hpp"

namespace mortise::qp {

namespace {

constexpr double way_of_inverse = 1e-6;  // compliance of a row over its own
constexpr int repeats_of_inverse = 4;

using Eigen::VectorXd;

// With rows that are in no factor as intervals of any length: equations.
FeasibleSet with_equations(const FeasibleSet& set, Eigen::Index rows)
{
  std::vector<char> taken(static_cast<std::size_t>(rows), 0);
  for (const Local i : set.constrained()) taken[static_cast<std::size_t>(i)] = 1;
  std::vector<Bound> bounds(set.bounds().begin(), set.bounds().end());
  std::vector<Disc> discs(set.discs().begin(), set.discs().end());
  for (Local i = 0; i < rows; ++i)
    if (taken[static_cast<std::size_t>(i)] == 0) discs.push_back({{i, -1}});
  return {std::move(bounds), std::move(discs)};
}

}  // namespace

SparseNewton::SparseNewton(SparseMatrices matrices, bool patient) : matrices_(std::move(matrices)), patient_(patient) {}

CondensedNewton::Result SparseNewton::solve(const VectorXd& f, const VectorXd& c, const FeasibleSet& set,
                                            const CondensedNewton::Result* near) const
{
  const FeasibleSet whole = with_equations(set, matrices_.b.rows());
  StateSearch search({std::make_unique<SparseSystem>(matrices_, whole), whole, -c, -f}, patient_);
  bool converged = false;
  try {
    converged = near ? search.from(near->x, near->nu, near->reaction, near->converged) : search.from_anywhere();
  } catch (const Error& error) {
    if (error.status() != ExitStatus::not_converged) throw;
  }
  auto point = search.point();
  point.converged = converged;
  point.reaction = search.reaction();
  return point;
}

struct SparseInverse::Data {
  SparseMatrices matrices;
  JoinedStiffness stiffness;
  VectorXd compliance;  // of the rows in the factor
  JoinedStiffness::Factor factor;

  explicit Data(SparseMatrices given)
      : matrices(std::move(given)),
        stiffness(matrices, rows_alone(matrices.b.rows())),
        compliance(compliance_of(matrices)),
        factor(factorized(stiffness, compliance))
  {
  }

 private:
  static std::vector<JoinedStiffness::Block> rows_alone(Eigen::Index rows)
  {
    std::vector<JoinedStiffness::Block> blocks;
    for (Local i = 0; i < rows; ++i) blocks.push_back({i});
    return blocks;
  }
  static VectorXd compliance_of(const SparseMatrices& matrices)
  {
    const VectorXd diagonal = matrices.k.diagonal();
    VectorXd compliance = matrices.s;
    for (int row = 0; row < matrices.b.rows(); ++row) {
      double own = matrices.s[row];
      for (decltype(matrices.b)::InnerIterator it(matrices.b, row); it; ++it) own += it.value() * it.value() / diagonal[it.col()];
      compliance[row] += way_of_inverse * own;
    }
    return compliance;
  }
  static JoinedStiffness::Factor factorized(JoinedStiffness& stiffness, const VectorXd& compliance)
  {
    std::vector<Eigen::MatrixXd> z;
    for (const double way : compliance) z.emplace_back(Eigen::MatrixXd::Constant(1, 1, 1 / way));
    auto factor = stiffness.factorize(z, z);
    if (!factor) throw Error(ExitStatus::not_converged, "the stiffness of the bodies is not positive definite to rounding");
    return std::move(*factor);
  }
};

SparseInverse::SparseInverse(SparseMatrices matrices) : data_(std::make_unique<Data>(std::move(matrices))) {}

SparseInverse::~SparseInverse() = default;
SparseInverse::SparseInverse(SparseInverse&&) noexcept = default;
SparseInverse& SparseInverse::operator=(SparseInverse&&) noexcept = default;

SparseInverse::Result SparseInverse::solve(const VectorXd& r, const VectorXd& f) const
{
  const auto& [k, b, s] = data_->matrices;
  Result result{VectorXd::Zero(r.size()), VectorXd::Zero(f.size())};
  auto& [x, u] = result;
  for (int repeat = 0; repeat < repeats_of_inverse; ++repeat) {
    VectorXd jump = r - b * u - s.cwiseProduct(x), force = f;
    force += b.transpose() * x;
    force -= k.selfadjointView<Eigen::Lower>() * u;
    // K du - B'dx = force, B du + (S + way) dx = jump
    VectorXd load = force;
    load += b.transpose() * jump.cwiseQuotient(data_->compliance);
    const VectorXd moved = data_->factor.solve(load);
    jump -= b * moved;
    x += jump.cwiseQuotient(data_->compliance);
    u += moved;
  }
  return result;
}

}  // namespace mortise::qp
