#include "condensed_programme.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace mortise::qp {

namespace {

constexpr double spring = 1e-8;        // on motions, of what constraints would hold them with
constexpr int most_repeats = 30;       // of solutions with springs,
constexpr double nearer_part = 0.5;    // as long as they leave less than this of what is lacking
constexpr double singular = 1e-11;     // reciprocal condition of what needs them
constexpr double definite = 1e-13;     // part of the diagonal that is added first
constexpr double indefinite = 1e-6;    // and that is too much
constexpr int fewest_steps = 8;        // of GMRES that are worth a beginning
constexpr Eigen::Index many = 1000;    // unknowns from which on factors serve several problems
constexpr double tiny_radius = 1e-12;  // of a disc, over the distance from its centre

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
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

CondensedProgramme::CondensedProgramme(const CondensedMatrices& matrices, const Eigen::LLT<MatrixXd>& factor_of_w,
                                       FeasibleSet set, VectorXd b, VectorXd e)
    : matrices_(matrices), set_(std::move(set)), b_(std::move(b)), e_(std::move(e)), own_(matrices.own)
{
  std::vector<int> bound_at(static_cast<std::size_t>(unknowns()), -1);
  const auto bounds = set_.bounds();
  for (std::size_t i = 0; i < bounds.size(); ++i) bound_at[static_cast<std::size_t>(bounds[i].index)] = static_cast<int>(i);
  for (const auto& disc : set_.discs()) {
    const bool follows = disc.coefficient > 0 && disc.normal >= 0;
    bound_of_.push_back(follows ? bound_at[static_cast<std::size_t>(disc.normal)] : -1);
    if (disc.size() == 2) own_[disc.index[0]] = own_[disc.index[1]] = std::max(own_[disc.index[0]], own_[disc.index[1]]);
  }
  MatrixXd gram = matrices.c + matrices.h * own_.cwiseInverse().asDiagonal() * matrices.h.transpose();
  springs_ = spring * gram.diagonal();
  if (motions() > 0) gram_ = factorize(gram);
  soften(0);
  if (unknowns() < many) return;
  VectorXd base = VectorXd::Zero(unknowns());
  bool symmetric = true;
  auto all = moves(all_closed(), base, symmetric);
  std::vector<Local> order;
  for (const auto& move : all) order.push_back(move.index[0]);
  factor_.emplace(std::move(all), [&factor_of_w, order](const MatrixXd& right) {
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

void CondensedProgramme::soften(double softness)
{
  softness_ = softness;
  softening_ = softness * own_;
  step_ = (own_ * (1 + softness)).cwiseInverse();
}

VectorXd CondensedProgramme::gradient(const VectorXd& x, const VectorXd& nu) const
{
  return matrices_.w * x + softness_ * own_.cwiseProduct(x) + matrices_.h.transpose() * nu - b_;
}

ConstraintStates CondensedProgramme::all_closed() const
{
  ConstraintStates all;
  all.closed.assign(set_.bounds().size(), 1);
  all.kind.assign(set_.discs().size(), ConstraintStates::Kind::sticks);
  all.slip.resize(set_.discs().size());
  return all;
}

ConstraintStates CondensedProgramme::states(const VectorXd& x, const VectorXd& nu) const
{
  const VectorXd y = x - step_.cwiseProduct(gradient(x, nu));
  const auto discs = set_.discs();
  ConstraintStates result = all_closed();
  for (std::size_t i = 0; i < result.closed.size(); ++i) {
    const auto& bound = set_.bounds()[i];
    result.closed[i] = y[bound.index] > bound.lower;
  }
  for (std::size_t d = 0; d < discs.size(); ++d) {
    const auto& disc = discs[d];
    const int bound = bound_of_[d];
    if (bound >= 0 && !result.closed[static_cast<std::size_t>(bound)]) {
      result.kind[d] = ConstraintStates::Kind::gone;
      continue;
    }
    auto& slip = result.slip[d];
    const Vector2d w = from_centre(disc, y);
    const double length = w.norm();
    slip.radius = bound >= 0 ? disc.coefficient * y[disc.normal] : disc.radius;
    if (length <= slip.radius) continue;
    result.kind[d] = ConstraintStates::Kind::slips;
    slip.direction = w / length;
    slip.curvature = slip.radius > tiny_radius * length ? (length - slip.radius) / (step_[disc.index[0]] * slip.radius)
                                                        : std::numeric_limits<double>::infinity();
  }
  return result;
}

double CondensedProgramme::residual(const VectorXd& x, const VectorXd& nu) const
{
  VectorXd y = x - step_.cwiseProduct(gradient(x, nu));
  for (const auto& bound : set_.bounds()) y[bound.index] = std::max(y[bound.index], bound.lower);
  for (std::size_t d = 0; d < bound_of_.size(); ++d) {
    const auto& disc = set_.discs()[d];
    const double radius = bound_of_[d] >= 0 ? disc.coefficient * y[disc.normal] : disc.radius;
    const Vector2d w = from_centre(disc, y);
    if (const double length = w.norm(); length > radius)
      for (int k = 0; k < disc.size(); ++k) y[disc.index[static_cast<std::size_t>(k)]] += (radius / length - 1) * w[k];
  }
  double square = (x - y).cwiseProduct(own_).dot(x - y);
  if (motions() > 0) {
    const VectorXd missing = e_ - matrices_.h * x + matrices_.c * nu;
    square += missing.dot(gram_.solve(missing));
  }
  return std::sqrt(square);
}

double CondensedProgramme::size(const VectorXd& x) const
{
  const double square = x.cwiseProduct(own_).dot(x);
  return std::sqrt(square > 0 || motions() == 0 ? square : e_.dot(gram_.solve(e_)));
}

double CondensedProgramme::rounding(const VectorXd& x) const
{
  const VectorXd sum = matrices_.w.cwiseAbs() * x.cwiseAbs() + b_.cwiseAbs();
  return std::numeric_limits<double>::epsilon() *
         std::sqrt(sum.cwiseProduct(step_).cwiseProduct(step_).cwiseProduct(own_).dot(sum));
}

// `base`: what does not move; `symmetric`: trial and test are alike.
std::vector<Move> CondensedProgramme::moves(const ConstraintStates& states, VectorXd& base, bool& symmetric) const
{
  const auto bounds = set_.bounds();
  const auto discs = set_.discs();
  std::vector<Move> result;
  std::vector<std::size_t> move_of(bounds.size(), 0);
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (!states.closed[i]) {
      base[bounds[i].index] = bounds[i].lower;
      continue;
    }
    move_of[i] = result.size();
    result.push_back({{bounds[i].index, -1, -1}, {1, 0, 0}, {1, 0, 0}, 0});
  }
  for (std::size_t d = 0; d < discs.size(); ++d) {
    const auto& disc = discs[d];
    const auto& slip = states.slip[d];
    const auto at = [&](int k) { return disc.index[static_cast<std::size_t>(k)]; };
    if (states.kind[d] == ConstraintStates::Kind::sticks) {
      for (int k = 0; k < disc.size(); ++k) result.push_back({{at(k), -1, -1}, {1, 0, 0}, {1, 0, 0}, 0});
      continue;
    }
    for (int k = 0; k < disc.size(); ++k) base[at(k)] = disc.centre[static_cast<std::size_t>(k)];
    if (states.kind[d] == ConstraintStates::Kind::gone) continue;
    if (const int bound = bound_of_[d]; bound >= 0) {
      auto& move = result[move_of[static_cast<std::size_t>(bound)]];
      for (int k = 0; k < disc.size(); ++k) {
        move.index[static_cast<std::size_t>(k) + 1] = at(k);
        move.trial[static_cast<std::size_t>(k) + 1] = disc.coefficient * slip.direction[k];
      }
      symmetric = false;
    } else {
      for (int k = 0; k < disc.size(); ++k) base[at(k)] += slip.radius * slip.direction[k];
    }
    if (disc.size() == 2 && std::isfinite(slip.curvature)) {
      const double u = -slip.direction[1], v = slip.direction[0];
      result.push_back({{at(0), at(1), -1}, {u, v, 0}, {u, v, 0}, slip.curvature});
    }
  }
  return result;
}

// `matrix` nu = `right`; by springs that hold nu where it is, if the matrix is singular without. Else there are none: where
// contact is much stiffer than its bodies, what is weak beside it is not so beside them.
void CondensedProgramme::solve_with_springs(const MatrixXd& matrix, const VectorXd& right, VectorXd& nu) const
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

void CondensedProgramme::solve(const ConstraintStates& states, VectorXd& x, VectorXd& nu)
{
  VectorXd base = VectorXd::Zero(unknowns());
  bool symmetric = true;
  auto all = moves(states, base, symmetric);
  const MoveProblem problem(matrices_, softening_, std::move(all), symmetric);
  const VectorXd right = problem.test(b_ - matrices_.w * base - softening_.cwiseProduct(base));
  const VectorXd lacking = e_ - matrices_.h * base;
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
  const VectorXd alone = factor.solve(right);
  VectorXd amount = alone;
  if (motions() > 0) {
    const MatrixXd response = factor.solve(problem.push());
    solve_with_springs(matrices_.c + problem.motion() * response, problem.motion() * alone - lacking, nu);
    amount -= response * nu;
  }
  x += problem.extend(amount);
  if (problem.size() >= many) factor_ = std::move(factor);
}

}  // namespace mortise::qp
