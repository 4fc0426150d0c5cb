#include "sparse_system.hpp"

#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace mortise::qp {

namespace {

constexpr double way_of_path = 1e-10;  // compliance of a row over its own, along the path
constexpr double way_of_guess = 1e-6;  // and in a guess, whose solution is repeated
constexpr int repeats_of_path = 2;
constexpr int repeats_of_guess = 8;    // at most,
constexpr double nearer_repeat = 0.5;  // as long as each leaves less than this of what the one before has left
constexpr double softest_ratio = 1e4;  // largest W_ii over own that is worth softening for: plates bend that much

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

// Sums of these terms decide about forces of which a thin body needs the seventeenth figure: its bending is 1e13 times as soft as
// its cells are.
using Extended = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

// -K u - B'x - e.
VectorXd lacking_forces(const SparseMatrices& matrices, const VectorXd& x, const Extended& u, const VectorXd& e)
{
  Extended sums = -e.cast<long double>();
  for (int j = 0; j < matrices.k.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(matrices.k, j); entry; ++entry) {
      const auto value = static_cast<long double>(entry.value());
      sums[entry.row()] -= value * u[j];
      if (entry.row() != j) sums[j] -= value * u[entry.row()];
    }
  for (int row = 0; row < matrices.b.rows(); ++row)
    for (decltype(matrices.b)::InnerIterator entry(matrices.b, row); entry; ++entry)
      sums[entry.col()] -= static_cast<long double>(entry.value()) * x[row];
  return sums.cast<double>();
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

SparseSystem::SparseSystem(const SparseMatrices& matrices, const FeasibleSet& set)
    : matrices_(matrices), diagonal_(matrices.k.diagonal()), own_(matrices.s), stiffness_(matrices, blocks_of(set, unknowns()))
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

// What moves in a guess, block by block: a = Y (E (B u - ..) ..), Y the inverse of what E S T and curvatures are, which gives way
// a little more.
struct SparseSystem::Moving {
  std::vector<MatrixXd> trial, test, inverse;  // T, E and Y of each block
  std::vector<VectorXd> curvature;

  VectorXd extend(const std::vector<JoinedStiffness::Block>& blocks, const std::vector<VectorXd>& a, VectorXd x) const
  {
    for (std::size_t k = 0; k < blocks.size(); ++k) x(blocks[k]) += trial[k] * a[k];
    return x;
  }
};

SparseSystem::Moving SparseSystem::moving(const Guess& guess) const
{
  const auto& blocks = stiffness_.blocks();
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
    compliance += way_of_guess * (test * own.asDiagonal() * test.transpose());
    result.inverse.push_back(count > 0 ? MatrixXd(compliance.inverse()) : MatrixXd(0, 0));
    result.trial.push_back(std::move(trial));
    result.test.push_back(std::move(test));
    result.curvature.push_back(std::move(curvature));
  }
  return result;
}

void SparseSystem::solve(const Guess& guess, const VectorXd& b, const VectorXd& e, VectorXd& x, VectorXd& u)
{
  const auto& blocks = stiffness_.blocks();
  const Moving moving = this->moving(guess);
  std::vector<MatrixXd> z, near;
  std::vector<VectorXd> amount;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    z.emplace_back(moving.trial[k] * moving.inverse[k] * moving.test[k]);
    near.push_back(guess.symmetric ? z[k] : MatrixXd(moving.test[k].transpose() * answered(moving.inverse[k]) * moving.test[k]));
    amount.emplace_back(VectorXd::Zero(moving.test[k].rows()));  // what rows share out stays even
  }
  const auto factor = stiffness_.factorize(std::move(z), near);
  if (!factor) {  // states that hold nothing
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  double before = std::numeric_limits<double>::infinity();
  Extended exact_u = u.cast<long double>();
  for (int repeat = 0; repeat < repeats_of_guess; ++repeat) {
    x = moving.extend(blocks, amount, guess.base);
    u = exact_u.cast<double>();
    const VectorXd felt = give(x) + guess.softening.cwiseProduct(x) + push(u) - b;
    const VectorXd missing = lacking_forces(matrices_, x, exact_u, e);
    std::vector<VectorXd> change;
    double square = this->square(missing);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const VectorXd lacking = -(moving.test[k] * felt(blocks[k])) - moving.curvature[k].cwiseProduct(amount[k]);
      square += lacking.squaredNorm();
      change.emplace_back(moving.inverse[k] * lacking);
    }
    const VectorXd pushed = moving.extend(blocks, change, VectorXd::Zero(x.size()));
    const VectorXd step = factor->solve(missing - matrices_.b.transpose() * pushed), jump = matrices_.b * step;
    for (std::size_t k = 0; k < blocks.size(); ++k)
      amount[k] += change[k] + moving.inverse[k] * (moving.test[k] * jump(blocks[k]));
    exact_u += step.cast<long double>();
    if (repeat > 1 && std::sqrt(square) > nearer_repeat * before) break;
    before = std::sqrt(square);
  }
  x = moving.extend(blocks, amount, guess.base);
  u = exact_u.cast<double>();
}

// Theta + S of the path, block by block, and what its rows give way besides.
class SparseSystem::Step : public PathFactor {
 public:
  // `inverse`: of theta and what gives way besides.
  Step(const SparseSystem& system, JoinedStiffness::Factor factor, std::vector<MatrixXd> theta, std::vector<MatrixXd> inverse,
       std::span<const Local> pinned)
      : system_(system),
        factor_(std::move(factor)),
        theta_(std::move(theta)),
        inverse_(std::move(inverse)),
        pinned_(pinned.begin(), pinned.end())
  {
  }

  PathFactor::Step solve(const VectorXd& forces, const VectorXd& lack, bool roughly) const override
  {
    const auto& blocks = system_.stiffness_.blocks();
    const auto& b = system_.matrices_.b;
    VectorXd right = forces;
    for (const Local i : pinned_) right[i] = 0;
    PathFactor::Step step{VectorXd::Zero(forces.size()), VectorXd::Zero(lack.size())};
    const VectorXd none = VectorXd::Zero(lack.size());
    for (int repeat = 0; repeat < (roughly ? 1 : repeats_of_path); ++repeat) {
      VectorXd felt = right;
      VectorXd missing = lack;
      if (repeat > 0) {
        felt += b * step.nu - times(blocks, theta_, step.x);
        for (const Local i : pinned_) felt[i] = 0;
        missing += system_.excess(step.x, step.nu, none);
      }
      VectorXd load = missing;
      load -= b.transpose() * times(blocks, inverse_, felt);
      const VectorXd moved = factor_.solve(load);
      felt += b * moved;
      step.x += times(blocks, inverse_, felt);
      step.nu += moved;
    }
    return step;
  }

 private:
  const SparseSystem& system_;
  JoinedStiffness::Factor factor_;
  std::vector<MatrixXd> theta_, inverse_;
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
  std::vector<MatrixXd> inverse = theta, near = theta;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    theta[k].diagonal() += matrices_.s(blocks[k]);
    MatrixXd softer = theta[k];
    softer.diagonal() += way_of_path * own_(blocks[k]);
    inverse[k] = softer.inverse();
    const MatrixXd even = answered(softer);
    near[k] = even == softer ? inverse[k] : MatrixXd(even.inverse());
    near[k] = 0.5 * (near[k] + near[k].transpose()).eval();
    if (even == softer) inverse[k] = near[k];
  }
  for (const Local i : pinned) {
    const auto [block, within] = stiffness_.in_block(i);
    for (auto* matrix : {&inverse[static_cast<std::size_t>(block)], &near[static_cast<std::size_t>(block)]}) {
      matrix->row(within).setZero();
      matrix->col(within).setZero();
    }
  }
  auto factor = stiffness_.factorize(inverse, near);
  if (!factor) fail();
  return std::make_unique<Step>(*this, std::move(*factor), std::move(theta), std::move(inverse), pinned);
}

}  // namespace mortise::qp
