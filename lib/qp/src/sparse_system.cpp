#include "sparse_system.hpp"

#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace mortise::qp {

namespace {

constexpr double way_of_path = 1e-10;   // compliance of a row over its own, along the path
constexpr double way_of_guess = 1e-6;   // and in a guess, whose solution is repeated;
constexpr double way_of_whole = 1e-10;  // where nothing is eliminated that could become too stiff
constexpr int repeats_of_path = 2;
constexpr int repeats_of_guess = 8;     // at most,
constexpr double nearer_repeat = 0.5;   // as long as each leaves less than this of what the one before has left
constexpr int repeats_of_balance = 20;  // so, too
constexpr double softest_ratio = 1e4;   // largest W_ii over own that is worth softening for: plates bend that much

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Bounds with the disc that follows them, discs alone, rows alone.
std::vector<JoinedStiffness::Block> blocks_of(const FeasibleSet& set, Index rows)
{
  std::vector<int> block_of(static_cast<std::size_t>(rows), -1);
  std::vector<JoinedStiffness::Block> blocks;
  for (const auto& bound : set.bounds()) {
    block_of[static_cast<std::size_t>(bound.index)] = static_cast<int>(blocks.size());
    blocks.push_back({bound.index});
  }
  for (const auto& disc : set.discs()) {
    const bool follows = disc.coefficient > 0 && disc.normal >= 0 && block_of[static_cast<std::size_t>(disc.normal)] >= 0;
    const int block = follows ? block_of[static_cast<std::size_t>(disc.normal)] : static_cast<int>(blocks.size());
    if (!follows) blocks.emplace_back();
    for (int k = 0; k < disc.size(); ++k) {
      const Local row = disc.index[static_cast<std::size_t>(k)];
      block_of[static_cast<std::size_t>(row)] = block;
      blocks[static_cast<std::size_t>(block)].push_back(row);
    }
  }
  for (Local row = 0; row < rows; ++row)
    if (block_of[static_cast<std::size_t>(row)] < 0) blocks.push_back({row});
  return blocks;
}

// The symmetric part of a block without what one unknown does to another that does not answer.
MatrixXd answered(const MatrixXd& block)
{
  MatrixXd result = 0.5 * (block + block.transpose());
  for (Index i = 0; i < block.rows(); ++i)
    for (Index j = 0; j < block.cols(); ++j)
      if (block(i, j) == 0 || block(j, i) == 0) result(i, j) = 0;
  return result;
}

std::vector<MatrixXd> zeros(const std::vector<JoinedStiffness::Block>& blocks)
{
  std::vector<MatrixXd> result;
  for (const auto& block : blocks) {
    const auto n = static_cast<Index>(block.size());
    result.push_back(MatrixXd::Zero(n, n));
  }
  return result;
}

VectorXd times(const std::vector<JoinedStiffness::Block>& blocks, const std::vector<MatrixXd>& matrices, const VectorXd& x)
{
  VectorXd result(x.size());
  for (std::size_t k = 0; k < blocks.size(); ++k) result(blocks[k]) = matrices[k] * x(blocks[k]);
  return result;
}

[[noreturn]] void fail()
{
  throw Error(ExitStatus::not_converged, "contact does not hold the bodies: their stiffness is singular to rounding");
}

}  // namespace

SparseSystem::SparseSystem(const SparseMatrices& matrices, const FeasibleSet& set, Factors factors)
    : matrices_(matrices),
      factors_(factors),
      diagonal_(matrices.k.diagonal()),
      own_(matrices.s),
      stiffness_(matrices, blocks_of(set, unknowns()))
{
  for (int row = 0; row < matrices.b.rows(); ++row)
    for (decltype(matrices_.b)::InnerIterator it(matrices_.b, row); it; ++it)
      if (diagonal_[it.col()] > 0) own_[row] += it.value() * it.value() / diagonal_[it.col()];
  // What has no stiffness is as stiff as the rows that hold it.
  VectorXd by_rows = VectorXd::Zero(diagonal_.size());
  for (int row = 0; row < matrices.b.rows(); ++row)
    for (decltype(matrices_.b)::InnerIterator it(matrices_.b, row); it; ++it)
      if (own_[row] > 0) by_rows[it.col()] += it.value() * it.value() / own_[row];
  diagonal_ = (diagonal_.array() > 0).select(diagonal_, by_rows);
  own_ = shared_by_discs(std::move(own_), set);
}

double SparseSystem::largest_ratio() const
{
  return softest_ratio;
}

VectorXd SparseSystem::excess(const VectorXd& x, const VectorXd& u, const VectorXd& e) const
{
  VectorXd force = matrices_.k.selfadjointView<Eigen::Lower>() * u;
  force += matrices_.b.transpose() * x;
  return -force - e;
}

double SparseSystem::square_of_rounding(const VectorXd& x, const VectorXd& u) const
{
  const SparseMatrix sizes = matrices_.k.cwiseAbs();
  const VectorXd large = u.cwiseAbs();
  VectorXd force = sizes.selfadjointView<Eigen::Lower>() * large;
  force += matrices_.b.cwiseAbs().transpose() * x.cwiseAbs();
  return square(force);
}

// What moves in a guess, block by block: a with E (S x + .. - B u) + curvatures a = .., x = base + T a.
struct SparseSystem::Moving {
  BlockEquations equations;  // C: what E S T and curvatures are, which gives way a little more
  std::vector<VectorXd> curvature;

  VectorXd extend(const std::vector<JoinedStiffness::Block>& blocks, const std::vector<VectorXd>& a, VectorXd x) const
  {
    for (std::size_t k = 0; k < blocks.size(); ++k) x(blocks[k]) += equations.trial[k] * a[k];
    return x;
  }
};

SparseSystem::Moving SparseSystem::moving(const Guess& guess) const
{
  const auto& blocks = stiffness_.blocks();
  const double way = factors_ == Factors::whole ? way_of_whole : way_of_guess;
  std::vector<std::vector<const Move*>> of_block(blocks.size());
  for (const auto& move : guess.moves)
    of_block[static_cast<std::size_t>(stiffness_.in_block(move.index[0]).block)].push_back(&move);
  Moving result;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto n = static_cast<Index>(blocks[k].size()), count = static_cast<Index>(of_block[k].size());
    MatrixXd trial = MatrixXd::Zero(n, count), test = MatrixXd::Zero(count, n);
    VectorXd curvature(count);
    for (Index j = 0; j < count; ++j) {
      const Move& move = *of_block[k][static_cast<std::size_t>(j)];
      curvature[j] = move.curvature;
      for (std::size_t i = 0; i < 3 && move.index[i] >= 0; ++i) {
        const Index at = stiffness_.in_block(move.index[i]).within;
        trial(at, j) = move.trial[i];
        test(j, at) = move.test[i];
      }
    }
    const VectorXd own = own_(blocks[k]), gives = matrices_.s(blocks[k]) + guess.softening(blocks[k]);
    MatrixXd compliance = test * gives.asDiagonal() * trial;
    compliance.diagonal() += curvature;
    compliance += way * (test * own.asDiagonal() * test.transpose());
    result.equations.compliance.push_back(std::move(compliance));
    result.equations.trial.push_back(std::move(trial));
    result.equations.test.push_back(std::move(test));
    result.curvature.push_back(std::move(curvature));
  }
  return result;
}

// None if the states hold nothing.
std::unique_ptr<LinearFactor> SparseSystem::factor_of(const Moving& moving, bool symmetric)
{
  const auto& [trial, test, compliance] = moving.equations;
  if (factors_ == Factors::whole) return saddle_factor(matrices_, stiffness_.blocks(), moving.equations);
  std::vector<MatrixXd> inverse, near;
  for (std::size_t k = 0; k < trial.size(); ++k) {
    inverse.push_back(compliance[k].rows() > 0 ? MatrixXd(compliance[k].inverse()) : MatrixXd(0, 0));
    near.push_back(symmetric ? MatrixXd(trial[k] * inverse[k] * test[k])
                             : MatrixXd(test[k].transpose() * answered(inverse[k]) * test[k]));
  }
  return eliminated_factor(stiffness_, moving.equations, std::move(inverse), near);
}

void SparseSystem::solve(const Guess& guess, const VectorXd& b, const VectorXd& e, VectorXd& x, VectorXd& u)
{
  const auto& blocks = stiffness_.blocks();
  const Moving moving = this->moving(guess);
  const auto factor = factor_of(moving, guess.symmetric);
  if (!factor) {
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  std::vector<VectorXd> amount;
  for (const auto& test : moving.equations.test)
    amount.emplace_back(VectorXd::Zero(test.rows()));  // what rows share out stays even
  double before = std::numeric_limits<double>::infinity();
  ExtendedVector exact_u = u.cast<long double>();
  for (int repeat = 0; repeat < repeats_of_guess; ++repeat) {
    x = moving.extend(blocks, amount, guess.base);
    u = exact_u.cast<double>();
    const VectorXd felt = give(x) + guess.softening.cwiseProduct(x) + push(u) - b;
    const VectorXd missing = lacking_forces(matrices_, x, exact_u, e);
    std::vector<VectorXd> lacking;
    double square = this->square(missing);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      lacking.emplace_back(-(moving.equations.test[k] * felt(blocks[k])) - moving.curvature[k].cwiseProduct(amount[k]));
      square += lacking.back().squaredNorm();
    }
    const auto step = factor->solve(missing, lacking);
    for (std::size_t k = 0; k < blocks.size(); ++k) amount[k] += step.a[k];
    exact_u += step.u.cast<long double>();
    if (repeat > 1 && std::sqrt(square) > nearer_repeat * before) break;
    before = std::sqrt(square);
  }
  x = moving.extend(blocks, amount, guess.base);
  u = exact_u.cast<double>();
}

// Theta + S of the path, block by block.
class SparseSystem::Step : public PathFactor {
 public:
  Step(const SparseSystem& system, std::unique_ptr<LinearFactor> factor, std::vector<MatrixXd> theta,
       std::span<const Local> pinned)
      : system_(system), factor_(std::move(factor)), theta_(std::move(theta)), pinned_(pinned.begin(), pinned.end())
  {
  }

  PathFactor::Step solve(const VectorXd& forces, const VectorXd& lack, bool roughly) const override
  {
    const auto& blocks = system_.stiffness_.blocks();
    PathFactor::Step step{VectorXd::Zero(forces.size()), VectorXd::Zero(lack.size())};
    ExtendedVector exact_nu = step.nu.cast<long double>();
    for (int repeat = 0; repeat < (roughly ? 1 : repeats_of_path); ++repeat) {
      VectorXd felt = forces - system_.push(step.nu) - times(blocks, theta_, step.x);
      for (const Local i : pinned_) felt[i] = 0;
      std::vector<VectorXd> lacking;
      for (const auto& block : blocks) lacking.emplace_back(felt(block));
      const auto more = factor_->solve(lacking_forces(system_.matrices_, step.x, exact_nu, -lack), lacking);
      for (std::size_t k = 0; k < blocks.size(); ++k) step.x(blocks[k]) += more.a[k];
      exact_nu += more.u.cast<long double>();
      step.nu = exact_nu.cast<double>();
    }
    return step;
  }

 private:
  const SparseSystem& system_;
  std::unique_ptr<LinearFactor> factor_;
  std::vector<MatrixXd> theta_;
  std::vector<Local> pinned_;
};

std::unique_ptr<PathFactor> SparseSystem::factor(std::span<const Stiffening> entries, std::span<const Local> pinned, bool) const
{
  const auto& blocks = stiffness_.blocks();
  auto theta = zeros(blocks);
  for (const auto& entry : entries) {
    const auto row = stiffness_.in_block(entry.row), column = stiffness_.in_block(entry.column);
    theta[static_cast<std::size_t>(row.block)](row.within, column.within) += entry.value;
  }
  BlockEquations equations{{}, {}, theta};
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    theta[k].diagonal() += matrices_.s(blocks[k]);
    equations.compliance[k] = theta[k];
    equations.compliance[k].diagonal() += way_of_path * own_(blocks[k]);
    equations.trial.emplace_back(MatrixXd::Identity(theta[k].rows(), theta[k].cols()));
  }
  auto factor = factor_of_path(std::move(equations), pinned);
  if (!factor) fail();
  return std::make_unique<Step>(*this, std::move(factor), std::move(theta), pinned);
}

// `equations` without what is pinned.
std::unique_ptr<LinearFactor> SparseSystem::factor_of_path(BlockEquations equations, std::span<const Local> pinned) const
{
  std::vector<MatrixXd> inverse, near;
  for (const auto& compliance : equations.compliance) {
    const MatrixXd even = answered(compliance);
    const bool symmetric = even == compliance;
    MatrixXd of_even = even.inverse();
    of_even = 0.5 * (of_even + of_even.transpose()).eval();
    inverse.push_back(symmetric ? of_even : MatrixXd(compliance.inverse()));
    near.push_back(std::move(of_even));
  }
  const auto leave_out = [](MatrixXd& matrix, Index i) {
    matrix.row(i).setZero();
    matrix.col(i).setZero();
  };
  for (const Local i : pinned) {
    const auto [in, within] = stiffness_.in_block(i);
    const auto block = static_cast<std::size_t>(in);
    for (auto* matrix : {&inverse[block], &near[block], &equations.trial[block], &equations.compliance[block]})
      leave_out(*matrix, within);
    equations.compliance[block](within, within) = 1;
  }
  equations.test = equations.trial;
  if (factors_ == Factors::whole) return saddle_factor(matrices_, stiffness_.blocks(), equations);
  return eliminated_factor(stiffness_, std::move(equations), std::move(inverse), near);
}

VectorXd SparseSystem::balance(std::span<const Local> rows, const VectorXd& f, VectorXd& x, VectorXd& u) const
{
  auto z = zeros(stiffness_.blocks());
  for (const Local i : rows) {
    const auto [block, within] = stiffness_.in_block(i);
    if (own_[i] > 0) z[static_cast<std::size_t>(block)](within, within) = 1 / own_[i];
  }
  const auto factor = stiffness_.factorize(z, z);
  ExtendedVector exact_u = u.cast<long double>();
  double before = std::numeric_limits<double>::infinity();
  for (int repeat = 0; factor && repeat < repeats_of_balance; ++repeat) {
    const VectorXd missing = lacking_forces(matrices_, x, exact_u, -f);
    if (!(missing.norm() < nearer_repeat * before)) break;
    before = missing.norm();
    const VectorXd step = factor->solve(missing);
    x += times(stiffness_.blocks(), z, matrices_.b * step);
    exact_u += step.cast<long double>();
  }
  u = exact_u.cast<double>();
  return (exact_u - u.cast<long double>()).cast<double>();
}

}  // namespace mortise::qp
