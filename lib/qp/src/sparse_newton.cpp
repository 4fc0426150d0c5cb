#include "qp/sparse_newton.hpp"

#include <limits>

#include "base/error.hpp"
#include "sparse_system.hpp"
#include "state_search.hpp"

namespace mortise::qp {

namespace {

constexpr double way_of_inverse = 1e-6;  // compliance of a row over its own
constexpr int repeats_of_inverse = 4;
constexpr int repeats_of_whole = 2;  // with nothing eliminated

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

// `near` as of SparseNewton::solve().
CondensedNewton::Result searched(const SparseMatrices& matrices, SparseSystem::Factors factors, bool patient, const VectorXd& f,
                                 const VectorXd& c, const FeasibleSet& set, const CondensedNewton::Result* near)
{
  auto made = std::make_unique<SparseSystem>(matrices, set, factors);
  const SparseSystem& system = *made;
  StateSearch search({std::move(made), set, -c, -f}, patient);
  bool converged = false;
  try {
    converged = near ? search.from(near->x, near->nu, near->reaction, near->converged) : search.from_anywhere();
  } catch (const Error& error) {
    if (error.status() != ExitStatus::not_converged) throw;
  }
  auto point = search.point();
  point.converged = converged;
  if (converged && patient) point.nu_rest = system.balance(search.free_forces(), f, point.x, point.nu);
  point.reaction = matrices.s.cwiseProduct(point.x) - matrices.b * point.nu + c;
  return point;
}

}  // namespace

SparseNewton::SparseNewton(SparseMatrices matrices, bool patient) : matrices_(std::move(matrices)), patient_(patient) {}

// Where sums with stiff constraints in them do not find a solution of thin bodies, factors of the whole system do.
CondensedNewton::Result SparseNewton::solve(const VectorXd& f, const VectorXd& c, const FeasibleSet& set,
                                            const CondensedNewton::Result* near) const
{
  using Factors = SparseSystem::Factors;
  const FeasibleSet all = with_equations(set, matrices_.b.rows());
  auto point = searched(matrices_, Factors::eliminated, patient_, f, c, all, near);
  const bool affordable = matrices_.k.cols() <= limits::States::few_motions_of_whole;
  if (point.converged || !patient_ || !affordable || (near && !near->converged)) return point;
  auto other = searched(matrices_, Factors::whole, patient_, f, c, all, near);
  return other.converged ? other : point;
}

struct SparseInverse::Data {
  SparseMatrices matrices;
  JoinedStiffness stiffness;
  BlockEquations equations;
  bool whole;
  std::unique_ptr<const LinearFactor> factor;

  Data(SparseMatrices given, bool wanted)
      : matrices(std::move(given)),
        stiffness(matrices, rows_alone(matrices.b.rows())),
        equations(equations_of(matrices)),
        whole(wanted && matrices.k.cols() <= limits::States::motions_of_one_whole)
  {
    if (whole) {
      factor = saddle_factor(matrices, stiffness.blocks(), equations);
    } else {
      std::vector<Eigen::MatrixXd> z;
      for (const auto& compliance : equations.compliance) z.emplace_back(compliance.inverse());
      factor = eliminated_factor(stiffness, equations, z, z);
    }
    if (!factor) throw Error(ExitStatus::not_converged, "the stiffness of the bodies is not positive definite to rounding");
  }

 private:
  static std::vector<JoinedStiffness::Block> rows_alone(Eigen::Index rows)
  {
    std::vector<JoinedStiffness::Block> blocks;
    for (Local i = 0; i < rows; ++i) blocks.push_back({i});
    return blocks;
  }
  // Each row gives way by S, and a tiny part of what its unknowns do.
  static BlockEquations equations_of(const SparseMatrices& matrices)
  {
    const VectorXd diagonal = matrices.k.diagonal();
    const auto one = [](double value) { return Eigen::MatrixXd(Eigen::MatrixXd::Constant(1, 1, value)); };
    BlockEquations equations;
    for (int row = 0; row < matrices.b.rows(); ++row) {
      double own = matrices.s[row];
      for (decltype(matrices.b)::InnerIterator it(matrices.b, row); it; ++it) own += it.value() * it.value() / diagonal[it.col()];
      equations.compliance.push_back(one(matrices.s[row] + way_of_inverse * own));
      equations.trial.push_back(one(1));
      equations.test.push_back(one(1));
    }
    return equations;
  }
};

SparseInverse::SparseInverse(SparseMatrices matrices, bool whole) : data_(std::make_unique<Data>(std::move(matrices), whole)) {}

SparseInverse::~SparseInverse() = default;
SparseInverse::SparseInverse(SparseInverse&&) noexcept = default;
SparseInverse& SparseInverse::operator=(SparseInverse&&) noexcept = default;

// K u + B'(-x) = f, S (-x) - B u = -r.
SparseInverse::Result SparseInverse::solve(const VectorXd& r, const VectorXd& f) const
{
  const auto& [k, b, s] = data_->matrices;
  Result result{VectorXd::Zero(r.size()), ExtendedVector::Zero(f.size())};
  auto& [x, u] = result;
  for (int repeat = 0; repeat < (data_->whole ? repeats_of_whole : repeats_of_inverse); ++repeat) {
    const VectorXd left = b * u.cast<double>() + s.cwiseProduct(x) - r;
    std::vector<VectorXd> lacking;
    for (const double value : left) lacking.push_back(VectorXd::Constant(1, value));
    const auto step = data_->factor->solve(lacking_forces(data_->matrices, -x, u, -f), lacking);
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] -= step.a[static_cast<std::size_t>(i)][0];
    u += step.u.cast<long double>();
  }
  return result;
}

}  // namespace mortise::qp
