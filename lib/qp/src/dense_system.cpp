#include "dense_system.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "base/dense.hpp"
#include "base/error.hpp"

namespace mortise::qp {

namespace {

constexpr double spring = 1e-8;      // on motions, of what constraints would hold them with
constexpr int most_repeats = 30;     // of solutions with springs,
constexpr double nearer_part = 0.5;  // as long as they leave less than this of what is lacking
constexpr double singular = 1e-11;   // reciprocal condition of what needs them
constexpr double definite = 1e-13;   // part of the diagonal that is added first
constexpr double indefinite = 1e-6;  // and that is too much
constexpr int fewest_steps = 8;      // of GMRES that are worth a beginning
constexpr Eigen::Index many = 1000;  // unknowns from which on factors serve several problems

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Eigen's factors, computed in pieces: the factor of a block on the diagonal, the rows below it, what these take from the rest.
class InPieces : public Eigen::LLT<MatrixXd> {
 public:
  explicit InPieces(MatrixXd a)
  {
    m_matrix = std::move(a);
    m_info = Eigen::Success;
    m_l1_norm = 0;  // rcond() is not asked for
    m_isInitialized = true;
    in_pieces(m_matrix.cols(), [&](Index first, Index count) {
      if (m_info != Eigen::Success) return;
      auto block = m_matrix.block(first, first, count, count);
      const Eigen::LLT<Eigen::Ref<MatrixXd>> inner(block);
      m_info = inner.info();
      const Index rest = m_matrix.rows() - first - count;
      if (m_info != Eigen::Success || rest == 0) return;
      auto below = m_matrix.block(first + count, first, rest, count);
      block.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
      m_matrix.bottomRightCorner(rest, rest).selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
    });
  }
};

}  // namespace

Eigen::LLT<MatrixXd> factorize(const MatrixXd& a)
{
  for (double part = definite; part < indefinite; part *= 1e2) {
    MatrixXd shifted = a;
    shifted.diagonal() *= 1 + part;
    InPieces factor(std::move(shifted));
    if (factor.info() == Eigen::Success) return factor;
  }
  throw Error(ExitStatus::not_converged,
              "the compliance of the contacts is not positive definite to rounding: their rows depend on each other");
}

bool invertible(const Eigen::PartialPivLU<MatrixXd>& factors, double least)
{
  return (factors.matrixLU().diagonal().array().abs() > 0).all() && factors.rcond() > least;
}

MatrixXd solve(const Eigen::LLT<MatrixXd>& factor, MatrixXd b)
{
  in_pieces(b.cols(), [&](Index first, Index count) { factor.solveInPlace(b.middleCols(first, count)); });
  return b;
}

DenseSystem::DenseSystem(const CondensedMatrices& matrices, const Eigen::LLT<MatrixXd>& factor_of_w, const FeasibleSet& set)
    : matrices_(matrices), factor_of_w_(factor_of_w)
{
  const VectorXd compliances = shared_by_discs(matrices.own, set);
  MatrixXd gram = matrices_.c + matrices_.h * compliances.cwiseInverse().asDiagonal() * matrices_.h.transpose();
  springs_ = spring * gram.diagonal();
  if (motions() > 0) gram_ = factorize(gram);
  if (unknowns() < many) return;
  auto closed = moves_of_closed(set);
  std::vector<Local> order;
  for (const auto& move : closed) order.push_back(move.index[0]);
  factor_.emplace(std::move(closed), [&factor_of_w = factor_of_w_, order](const MatrixXd& right) {
    MatrixXd x(factor_of_w.rows(), right.cols());
    x(order, Eigen::all) = right;
    if (x.cols() == 1) {  // not as a matrix, which would be packed for more columns
      auto column = x.col(0);
      factor_of_w.solveInPlace(column);
    } else {
      factor_of_w.solveInPlace(x);
    }
    return MatrixXd(x(order, Eigen::all));
  });
}

// `matrix` nu = `right`; by springs that hold nu where it is, if the matrix is singular without. Else there are none: where
// contact is much stiffer than its bodies, what is weak beside it is not so beside them.
void DenseSystem::solve_with_springs(const MatrixXd& matrix, const VectorXd& right, VectorXd& nu) const
{
  if (right.size() == 0) return;
  const Eigen::PartialPivLU<MatrixXd> alone(matrix);
  if (invertible(alone, singular)) {
    nu = alone.solve(right);
    return;
  }
  MatrixXd held = matrix;
  held.diagonal() += springs_;
  const Eigen::PartialPivLU<MatrixXd> factors(held);
  // Again and again from where they have led, so that motions that are held softly without them, as by a slender rod, do not feel
  // them; once where a motion is driven and not held, which would go on.
  const VectorXd unit = springs_.cwiseSqrt().cwiseInverse();
  VectorXd lack = right - matrix * nu;
  for (int repeat = 0; repeat < most_repeats; ++repeat) {
    const VectorXd next = nu + factors.solve(lack), left = right - matrix * next;
    const bool nearer = left.cwiseProduct(unit).norm() < nearer_part * lack.cwiseProduct(unit).norm();
    if (repeat > 0 && !nearer) return;
    nu = next;
    if (!nearer) return;
    lack = left;
  }
}

void DenseSystem::solve(const Guess& guess, const VectorXd& b, const VectorXd& e, VectorXd& x, VectorXd& nu)
{
  const VectorXd& base = guess.base;
  const MoveProblem problem(matrices_, guess.softening, guess.moves, guess.symmetric);
  const VectorXd right = problem.test(b - matrices_.w * base - guess.softening.cwiseProduct(base));
  const VectorXd lacking = e - matrices_.h * base;
  const int steps = factor_ && problem.size() >= many ? factor_->affordable_steps(problem) : 0;
  if (steps >= fewest_steps) {
    const VectorXd start = problem.test(VectorXd(x - base));
    if (const auto found = factor_->iterate(problem, right, lacking, springs_ / spring, {start, nu}, steps)) {
      x = base + problem.extend(found->amount);
      nu = found->nu;
      return;
    }
  }
  if (problem.size() >= many) factor_.reset();  // before there are others: they are large
  x = base;
  if (problem.size() == 0) {
    solve_with_springs(matrices_.c, -lacking, nu);
    return;
  }
  MoveFactor factor(problem);
  VectorXd amount = factor.solve(right);
  if (motions() > 0) {
    const MatrixXd response = factor.solve(problem.push()), stiffness = matrices_.c + problem.motion() * response;
    solve_with_springs(stiffness, problem.motion() * amount - lacking, nu);
    amount -= response * nu;
    // Once more: where rows depend on each other, or motions do much, figures are lost that decide about states.
    const VectorXd r = right - problem.matrix() * amount - problem.push() * nu;
    const VectorXd l = lacking - problem.motion() * amount + matrices_.c * nu;
    const VectorXd alone = factor.solve(r);
    VectorXd change = VectorXd::Zero(nu.size());
    solve_with_springs(stiffness, problem.motion() * alone - l, change);
    amount += alone - response * change;
    nu += change;
  }
  x += problem.extend(amount);
  if (problem.size() >= many) factor_ = std::move(factor);
}

namespace {

class DensePathFactor : public PathFactor {
 public:
  // W with its entries becomes factors. The matrices outlive it.
  DensePathFactor(const CondensedMatrices& matrices, MatrixXd matrix, std::span<const Local> pinned, bool symmetric)
      : matrices_(matrices), pinned_(pinned.begin(), pinned.end())
  {
    MatrixXd push = matrices.h.transpose();
    for (const Local i : pinned) {
      matrix.row(i).setZero();
      matrix.col(i).setZero();
      matrix(i, i) = 1;
      push.row(i).setZero();
    }
    if (symmetric)
      cholesky_.emplace(factorize(matrix));
    else
      lu_.emplace(std::move(matrix));
    if (push.cols() == 0) return;
    response_ = cholesky_ ? MatrixXd(cholesky_->solve(push)) : MatrixXd(lu_->solve(push));
    const MatrixXd stiffness = matrices.c + matrices.h * response_;
    unit_ = stiffness.diagonal().cwiseAbs().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
    motions_ = unit_.asDiagonal() * stiffness * unit_.asDiagonal();
  }

  Step solve(const VectorXd& forces, const VectorXd& lack, bool) const override
  {
    VectorXd right = forces;
    for (const Local i : pinned_) right[i] = 0;
    Step step{cholesky_ ? VectorXd(cholesky_->solve(right)) : VectorXd(lu_->solve(right)), VectorXd::Zero(lack.size())};
    if (lack.size() == 0) return step;
    const VectorXd driven = matrices_.h * step.x + lack;
    step.nu = unit_.cwiseProduct(dense::minimum_norm(motions_, unit_.cwiseProduct(driven)));
    step.x -= response_ * step.nu;
    return step;
  }

 private:
  const CondensedMatrices& matrices_;
  std::vector<Local> pinned_;
  std::optional<Eigen::LLT<MatrixXd>> cholesky_;
  std::optional<Eigen::PartialPivLU<MatrixXd>> lu_;
  MatrixXd response_;
  VectorXd unit_;
  MatrixXd motions_;  // of the scaled nu
};

}  // namespace

std::unique_ptr<PathFactor> DenseSystem::factor(std::span<const Stiffening> entries, std::span<const Local> pinned,
                                                bool symmetric) const
{
  MatrixXd matrix = matrices_.w;
  for (const auto& entry : entries) matrix(entry.row, entry.column) += entry.value;
  return std::make_unique<DensePathFactor>(matrices_, std::move(matrix), pinned, symmetric);
}

}  // namespace mortise::qp
