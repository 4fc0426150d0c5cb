// Programmes with dense matrices for the tests of the direct solution, and the conditions that a solution has to fulfil.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <random>

#include "qp/condensed_newton.hpp"

namespace mortise::qp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

struct MatrixProgramme {
  MatrixXd a, g;
  VectorXd b, e;
  FeasibleSet set;

  CondensedNewton condensed() const { return {a, g, MatrixXd::Zero(g.rows(), g.rows()), set}; }
  CondensedNewton::Result solve() const { return condensed().solve(b, e, set); }
};

// How far x and nu are from the conditions of a solution, over the size of forces and of gaps. Nothing of it comes from the code
// under test.
inline double violation(const MatrixProgramme& p, const CondensedNewton::Result& point)
{
  const auto &x = point.x, &nu = point.nu;
  if (!x.allFinite() || !nu.allFinite()) return std::numeric_limits<double>::infinity();
  const VectorXd gap = p.a * x - p.b + p.g.transpose() * nu;
  const double force = 1e-300 + x.cwiseAbs().maxCoeff(),
               length = 1e-300 + (p.a * x).cwiseAbs().maxCoeff() + p.b.cwiseAbs().maxCoeff();
  double worst = p.e.size() > 0 ? (p.g * x - p.e).cwiseAbs().maxCoeff() / (force * p.g.cwiseAbs().maxCoeff()) : 0;
  std::vector<char> bounded(static_cast<std::size_t>(x.size()), 0), constrained(bounded);
  for (const auto& bound : p.set.bounds()) {
    constrained[static_cast<std::size_t>(bound.index)] = bounded[static_cast<std::size_t>(bound.index)] = 1;
    const double pressed = (x[bound.index] - bound.lower) / force, open = gap[bound.index] / length;
    worst = std::max({worst, -pressed, -open, std::min(pressed, open)});
  }
  for (const auto& disc : p.set.discs()) {
    const bool follows = disc.coefficient > 0 && disc.normal >= 0 && bounded[static_cast<std::size_t>(disc.normal)];
    const double radius = follows ? disc.coefficient * x[disc.normal] : disc.radius;
    Vector2d tangential = Vector2d::Zero(), slip = Vector2d::Zero();
    for (int k = 0; k < disc.size(); ++k) {
      const Local i = disc.index[static_cast<std::size_t>(k)];
      constrained[static_cast<std::size_t>(i)] = 1;
      tangential[k] = x[i] - disc.centre[static_cast<std::size_t>(k)];
      slip[k] = gap[i] / length;
    }
    const double room = (radius - tangential.norm()) / force;
    const double against = tangential.norm() * slip.norm() + tangential.dot(slip);  // 0 if slip is opposite to the force
    worst = std::max({worst, -room, std::min(room, slip.norm()), against / force});
  }
  for (Index i = 0; i < x.size(); ++i)
    if (!constrained[static_cast<std::size_t>(i)]) worst = std::max(worst, std::abs(gap[i]) / length);
  return worst;
}

// What constraints are at a solution: a test in which nothing slips tells little of slip.
struct Census {
  int open = 0, closed = 0, sticks = 0, slips = 0;
  void add(const MatrixProgramme& p, const VectorXd& x)
  {
    for (const auto& bound : p.set.bounds()) ++(x[bound.index] > bound.lower + 1e-9 ? closed : open);
    for (const auto& disc : p.set.discs()) {
      const double radius = disc.coefficient > 0 ? disc.coefficient * x[disc.normal] : disc.radius;
      if (radius > 1e-9) ++(from_centre(disc, x).norm() < (1 - 1e-9) * radius ? sticks : slips);
    }
  }
};

class Random {
 public:
  explicit Random(int seed) : generator_(static_cast<unsigned>(seed)) {}
  MatrixXd matrix(Index rows, Index columns)
  {
    return MatrixXd::NullaryExpr(rows, columns, [&](Index, Index) { return normal_(generator_); });
  }
  MatrixXd definite(Index n, double least)
  {
    const MatrixXd root = matrix(n, n);
    return root * root.transpose() / static_cast<double>(n) + least * MatrixXd::Identity(n, n);
  }

 private:
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

// `points` contact nodes, each with a normal unknown and `tangents` others, among `free` unknowns without a constraint. The
// first `rigid` rows of G meet constraints alone, three more meet everything. Points at which all is pressed and little is pulled
// are feasible.
inline MatrixProgramme random_programme(int seed, int points, int tangents, int free, int rigid)
{
  Random random(seed);
  MatrixProgramme p;
  const Index each = 1 + tangents, n = points * each + free, mixed = free > 0 ? 3 : 0;
  p.a = random.definite(n, 0.1);
  p.b = 2 * random.matrix(n, 1);
  p.g = random.matrix(rigid + mixed, n);
  std::vector<Bound> bounds;
  std::vector<Disc> discs;
  VectorXd inside = 0.1 * random.matrix(n, 1);
  for (int i = 0; i < points; ++i) {
    const auto at = static_cast<Local>(free / 2 + i * each);
    bounds.push_back({at});
    inside[at] = 1 + std::abs(inside[at]);
    if (tangents == 0) continue;
    discs.push_back({{at + 1, tangents == 2 ? at + 2 : -1}, 0.3});
    discs.back().normal = at;
    for (int k = 1; k < each; ++k) inside[at + k] *= 0.1;
    if (i % 2 == 0) p.b.segment(at + 1, tangents) *= 0.1;
  }
  for (Index i = 0; i < n; ++i)
    if (i < free / 2 || i >= n - (free - free / 2)) p.g.topRows(rigid).col(i).setZero();
  p.e = p.g * inside;
  p.set = FeasibleSet(std::move(bounds), std::move(discs));
  return p;
}

}  // namespace mortise::qp
