#include "move_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "dense_system.hpp"
#include "gmres.hpp"

namespace mortise::qp {

namespace {

constexpr int most_steps = 120;      // of GMRES
constexpr double slow = 24;          // operations that factors are made with in the time of one entry of a matrix that is read
constexpr int look = 8;              // steps, whose pace foretells how many it will be
constexpr double reduction = 1e-4;   // of the residual: states are still guesses, and each next one goes on from there
constexpr double roundable = 1e-9;   // residual over the right-hand side that rounding may be all of
constexpr double exact = 1e-13;      // residual over the right-hand side
constexpr double least_held = 1e-8;  // reciprocal condition of motions: below, springs may be needed

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

template <class Visit>
void for_each_entry(const Move& move, const std::array<double, 3>& values, const Visit& visit)
{
  for (std::size_t k = 0; k < 3 && move.index[k] >= 0; ++k)
    if (values[k] != 0) visit(move.index[k], values[k]);
}

// Sum of values along the columns of `columns`.
VectorXd combine(const std::vector<Move>& moves, std::array<double, 3> Move::*direction, const VectorXd& a, Index size)
{
  VectorXd x = VectorXd::Zero(size);
  for (std::size_t j = 0; j < moves.size(); ++j)
    for_each_entry(moves[j], moves[j].*direction, [&](Local i, double v) { x[i] += v * a[static_cast<Index>(j)]; });
  return x;
}

MatrixXd ask(const std::vector<Move>& moves, const MatrixXd& x)
{
  MatrixXd result = MatrixXd::Zero(static_cast<Index>(moves.size()), x.cols());
  for (Index c = 0; c < x.cols(); ++c)
    for (std::size_t j = 0; j < moves.size(); ++j)
      for_each_entry(moves[j], moves[j].test, [&](Local i, double v) { result(static_cast<Index>(j), c) += v * x(i, c); });
  return result;
}

// A^-1 right. One column goes through the factors as a vector: as a matrix it would be packed for others that are not there.
template <class Factor>
MatrixXd times_inverse(const Factor& factor, const MatrixXd& right)
{
  if (right.cols() == 1) return VectorXd(factor.solve(right.col(0)));
  return factor.solve(right);
}

}  // namespace

MoveProblem::MoveProblem(const CondensedMatrices& matrices, const VectorXd& softening, std::vector<Move> moves, bool symmetric)
    : matrices_(matrices), softening_(softening), moves_(std::move(moves)), symmetric_(symmetric)
{
  const auto& h = matrices_.h;
  matrix_ = make_matrix();
  push_ = MatrixXd::Zero(size(), h.rows());
  motion_ = MatrixXd::Zero(h.rows(), size());
  for (Index j = 0; j < size(); ++j) {
    const auto& move = moves_[static_cast<std::size_t>(j)];
    for_each_entry(move, move.trial, [&](Local i, double v) { motion_.col(j) += v * h.col(i); });
    for_each_entry(move, move.test, [&](Local i, double v) { push_.row(j) += v * h.col(i).transpose(); });
  }
}

VectorXd MoveProblem::extend(const VectorXd& a) const
{
  return combine(moves_, &Move::trial, a, matrices_.w.rows());
}

VectorXd MoveProblem::test(const VectorXd& x) const
{
  return ask(moves_, x);
}

MatrixXd MoveProblem::make_matrix() const
{
  const auto& w = matrices_.w;
  MatrixXd result(size(), size());
  for (Index j = 0; j < size(); ++j) {
    const auto& move = moves_[static_cast<std::size_t>(j)];
    VectorXd moved = VectorXd::Zero(w.rows());
    for_each_entry(move, move.trial, [&](Local i, double v) {
      moved += v * w.col(i);
      moved[i] += softening_[i] * v;
    });
    result.col(j) = test(moved);
    result(j, j) += move.curvature;
  }
  return result;
}

MoveFactor::MoveFactor(const MoveProblem& problem) : moves_(problem.moves())
{
  if (problem.symmetric())
    solve_ = [factor = std::make_shared<const Eigen::LLT<MatrixXd>>(factorize(problem.matrix()))](const MatrixXd& right) {
      return times_inverse(*factor, right);
    };
  else
    solve_ = [factor = std::make_shared<const Eigen::PartialPivLU<MatrixXd>>(problem.matrix())](const MatrixXd& right) {
      return times_inverse(*factor, right);
    };
}

// Steps of GMRES on `problem` that take as long as new factors of it, each of which reads its matrix and the old factors.
int MoveFactor::affordable_steps(const MoveProblem& problem) const
{
  const auto n = static_cast<double>(problem.size()), old = static_cast<double>(moves_.size());
  const double factors = (problem.symmetric() ? 1 : 2) * n * n * n / 3;
  return static_cast<int>(std::min<double>(most_steps, factors / (slow * (n * n + old * old))));
}

// About the inverse of [M B; N -C] of another problem.
class MoveFactor::Inverse {
 public:
  // `scale` measures lacks of N a - C nu, as in iterate().
  Inverse(const MoveFactor& factor, const MoveProblem& problem, const VectorXd& scale) : factor_(factor), problem_(problem)
  {
    const auto& matrices = problem.matrices();
    // What of each direction the old problem had fixed.
    std::vector<std::array<std::pair<Index, double>, 2>> old(static_cast<std::size_t>(matrices.w.rows()), {{{-1, 0}, {-1, 0}}});
    for (std::size_t j = 0; j < factor.moves_.size(); ++j)
      for_each_entry(factor.moves_[j], factor.moves_[j].test, [&](Local i, double v) {
        auto& entries = old[static_cast<std::size_t>(i)];
        entries[entries[0].first < 0 ? 0 : 1] = {static_cast<Index>(j), v};
      });
    alone_.resize(problem.size());
    for (Index j = 0; j < problem.size(); ++j) {
      const auto& move = problem.moves()[static_cast<std::size_t>(j)];
      std::vector<std::pair<Index, double>> known;
      double own = 0;
      for_each_entry(move, move.test, [&](Local i, double v) {
        own += v * v * (matrices.own[i] + problem.softening()[i]);
        for (const auto& [o, part] : old[static_cast<std::size_t>(i)]) {
          if (o < 0) continue;
          const auto found = std::find_if(known.begin(), known.end(), [o = o](const auto& k) { return k.first == o; });
          if (found == known.end())
            known.emplace_back(o, v * part);
          else
            found->second += v * part;
        }
      });
      double fixed = 1;
      for (const auto& [o, part] : known) fixed -= part * part;
      alone_[j] = std::max(fixed, 0.0) / (own + move.curvature);
    }
    response_ = inverse_of_m(problem.push());
    const MatrixXd stiffness = matrices.c + problem.motion() * response_;
    if (stiffness.size() == 0) return;
    const VectorXd unit = scale.cwiseSqrt().cwiseInverse();
    held_ = invertible(Eigen::PartialPivLU<MatrixXd>(unit.asDiagonal() * stiffness * unit.asDiagonal()), least_held);
    motions_.compute(stiffness);
  }
  // Whether motions are held so that springs are none of their matter.
  bool holds() const { return held_; }
  Solution operator()(const VectorXd& r, const VectorXd& l) const
  {
    Solution result{inverse_of_m(r), VectorXd::Zero(l.size())};
    if (l.size() == 0) return result;
    result.nu = motions_.solve(problem_.motion() * result.amount - l);
    result.amount -= response_ * result.nu;
    return result;
  }

 private:
  MatrixXd inverse_of_m(const MatrixXd& r) const
  {
    MatrixXd result = alone_.asDiagonal() * r;
    const auto n = problem_.matrices().w.rows();
    MatrixXd felt(n, r.cols());
    for (Index c = 0; c < r.cols(); ++c) felt.col(c) = combine(problem_.moves(), &Move::test, r.col(c), n);
    const MatrixXd amount = factor_.solve_(ask(factor_.moves_, felt));
    for (Index c = 0; c < r.cols(); ++c) felt.col(c) = combine(factor_.moves_, &Move::trial, amount.col(c), n);
    return result + ask(problem_.moves(), felt);
  }

  const MoveFactor& factor_;
  const MoveProblem& problem_;
  VectorXd alone_;
  MatrixXd response_;
  bool held_ = true;
  Eigen::PartialPivLU<MatrixXd> motions_;
};

std::optional<MoveFactor::Solution> MoveFactor::iterate(const MoveProblem& problem, const VectorXd& r, const VectorXd& l,
                                                        const VectorXd& scale, const Solution& start, int most) const
{
  const Inverse inverse(*this, problem, scale);
  if (!inverse.holds()) return {};
  const auto& c = problem.matrices().c;
  const Index n = r.size(), m = l.size();
  VectorXd weight(n + m);
  for (Index j = 0; j < n; ++j) {
    double own = 0;
    const auto& move = problem.moves()[static_cast<std::size_t>(j)];
    for_each_entry(move, move.test,
                   [&](Local i, double v) { own += v * v * (problem.matrices().own[i] + problem.softening()[i]); });
    weight[j] = 1 / std::sqrt(own);
  }
  weight.tail(m) = scale.cwiseSqrt().cwiseInverse();
  const auto join = [&](const VectorXd& a, const VectorXd& b) {
    VectorXd both(n + m);
    both << a, b;
    return VectorXd(both.cwiseProduct(weight));
  };
  const auto image = [&](const Solution& s) {
    return join(problem.matrix() * s.amount + problem.push() * s.nu, problem.motion() * s.amount - c * s.nu);
  };
  const auto solve = [&](const VectorXd& both) {
    return inverse(both.head(n).cwiseQuotient(weight.head(n)), both.tail(m).cwiseQuotient(weight.tail(m)));
  };
  const VectorXd right = join(r, l);
  Solution at = start;
  const VectorXd residual = right - image(at);
  const double size = residual.norm(), enough = exact * right.norm();
  if (!std::isfinite(size)) return {};
  if (size <= enough) return at;
  if (size <= roundable * right.norm()) {
    VectorXd rounding = VectorXd::Zero(n);
    for (Index j = 0; j < n; ++j) rounding += problem.matrix().col(j).cwiseAbs() * std::abs(at.amount[j]);
    if (size <= 10 * std::numeric_limits<double>::epsilon() * rounding.cwiseProduct(weight.head(n)).norm()) return at;
  }
  VectorXd z = VectorXd::Zero(n + m);
  const double goal = std::max(reduction * size, 0.1 * enough);
  const double reached = gmres([&](const VectorXd& v) { return image(solve(v)); }, residual, goal, most, z, look);
  if (!(reached <= goal)) return {};
  const Solution step = solve(z);
  at.amount += step.amount;
  at.nu += step.nu;
  return at;
}

}  // namespace mortise::qp
