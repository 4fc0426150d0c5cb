// The direct solution against the conditions that it has to fulfil, against all guesses tried one by one, and against closed
// forms.
#include "qp/condensed_newton.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <csignal>
#include <numbers>
#include <random>

#include "base/error.hpp"
#include "base/interruption.hpp"

namespace mortise::qp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

struct Programme {
  MatrixXd a, g;
  VectorXd b, e;
  FeasibleSet set;

  CondensedNewton condensed() const { return {a, g, MatrixXd::Zero(g.rows(), g.rows()), set}; }
  CondensedNewton::Point solve() const { return condensed().solve(b, e, set); }
};

// How far x and nu are from the conditions of a solution, over the size of forces and of gaps. Nothing of it comes from the code
// under test.
double violation(const Programme& p, const CondensedNewton::Point& point)
{
  const auto& [x, nu, converged, steps] = point;
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
  void add(const Programme& p, const VectorXd& x)
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
Programme random_programme(int seed, int points, int tangents, int free, int rigid)
{
  Random random(seed);
  Programme p;
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

TEST(CondensedNewton, BoundsAloneAtEverySeed)
{
  Census census;
  for (int seed = 1; seed <= 30; ++seed)
    for (const auto& [free, rigid] : {std::pair{0, 0}, {0, 2}, {20, 0}, {20, 4}}) {
      const auto p = random_programme(seed, 30, 0, free, rigid);
      const auto point = p.solve();
      EXPECT_TRUE(point.converged) << seed;
      EXPECT_LT(violation(p, point), 1e-9) << seed;
      census.add(p, point.x);
    }
  EXPECT_GT(census.open, 500);
  EXPECT_GT(census.closed, 500);
}

TEST(CondensedNewton, TrescaDiscsAtEverySeed)
{
  for (const int tangents : {1, 2}) {
    Census census;
    for (int seed = 1; seed <= 30; ++seed)
      for (const auto& [free, rigid] : {std::pair{0, 0}, {20, 0}, {20, 4}}) {
        const auto p = random_programme(seed, 20, tangents, free, rigid);
        const auto point = p.solve();
        EXPECT_TRUE(point.converged) << seed;
        EXPECT_LT(violation(p, point), 1e-9) << seed;
        census.add(p, point.x);
      }
    EXPECT_GT(census.open, 200);
    EXPECT_GT(census.closed, 200);
    EXPECT_GT(census.sticks, 30);
    EXPECT_GT(census.slips, 200);
  }
}

// Discs of radius 0 pin, those of an infinite one do nothing, and centres are where they are.
TEST(CondensedNewton, DiscsOfEveryRadiusAndCentre)
{
  for (const int tangents : {1, 2}) {
    const auto base = random_programme(5, 12, tangents, 10, 2);
    std::vector<Disc> discs(base.set.discs().begin(), base.set.discs().end());
    discs[0].radius = discs[1].radius = 0;
    discs[2].radius = discs[3].radius = std::numeric_limits<double>::infinity();
    discs[4].centre = {0.5, tangents == 2 ? -0.25 : 0};
    discs[1].centre = {0.1, 0};
    auto p = base;
    p.set = FeasibleSet({base.set.bounds().begin(), base.set.bounds().end()}, discs);
    const auto point = p.solve();
    EXPECT_TRUE(point.converged);
    EXPECT_NEAR(from_centre(discs[1], point.x).norm(), 0, 1e-14);
    for (auto& disc : discs) disc.radius = std::min(disc.radius, 1e3);
    p.set = FeasibleSet({base.set.bounds().begin(), base.set.bounds().end()}, discs);
    EXPECT_LT(violation(p, point), 1e-9);
  }
}

// Coefficients up to 2 on points that hardly couple normal and tangent, as those of bodies do: what says that it is settled is.
TEST(CondensedNewton, CoulombConesAtEverySeed)
{
  for (const int tangents : {1, 2})
    for (const double coefficient : {0.05, 0.3, 0.8, 2.0}) {
      Census census;
      for (int seed = 1; seed <= 30; ++seed)
        for (const auto& [free, rigid] : {std::pair{0, 0}, {20, 0}, {20, 4}}) {
          auto p = random_programme(seed, 20, tangents, free, rigid);
          p.set.set_coefficients(std::vector<double>(20, coefficient));
          p.a.diagonal().array() += 1;
          const auto point = p.solve();
          EXPECT_TRUE(point.converged) << seed;
          EXPECT_LT(violation(p, point), 1e-9) << seed << " " << coefficient << " " << free << " " << rigid;
          census.add(p, point.x);
        }
      EXPECT_GT(census.open, 200);
      EXPECT_GT(census.closed, 200);
      EXPECT_GT(census.slips, 100);
      EXPECT_GT(census.sticks, 5);
    }
}

// All guesses of what each constraint does, one by one: 2 for a bound, 3 for a disc of one unknown, 4 for a point of Coulomb's
// law. Those that fulfil the conditions.
std::vector<VectorXd> brute_force(const Programme& p)
{
  const Index n = p.b.size(), m = p.e.size();
  const auto bounds = p.set.bounds();
  const auto discs = p.set.discs();
  std::vector<int> guess(bounds.size() + discs.size(), 0);  // 0: free; 1: at the bound; of a disc 1 and 2: at its edges
  std::vector<VectorXd> found;
  for (bool more = true; more;) {
    // Rows: A x + G'nu = b where free, else what is known of x; G x = e.
    MatrixXd matrix = MatrixXd::Zero(n + m, n + m);
    VectorXd right(n + m);
    right << p.b, p.e;
    matrix << p.a, p.g.transpose(), p.g, MatrixXd::Zero(m, m);
    const auto fix = [&](Local i, double value) {
      matrix.row(i).setZero();
      matrix(i, i) = 1;
      right[i] = value;
    };
    for (std::size_t i = 0; i < bounds.size(); ++i)
      if (guess[i] == 1) fix(bounds[i].index, bounds[i].lower);
    for (std::size_t d = 0; d < discs.size(); ++d) {
      const int state = guess[bounds.size() + d];
      if (state == 0) continue;
      const double sign = state == 1 ? 1 : -1;
      fix(discs[d].index[0], discs[d].coefficient > 0 ? 0 : discs[d].centre[0] + sign * discs[d].radius);
      if (discs[d].coefficient > 0) matrix(discs[d].index[0], discs[d].normal) -= sign * discs[d].coefficient;
    }
    const Eigen::FullPivLU<MatrixXd> factor(matrix);
    if (factor.isInvertible()) {
      const VectorXd all = factor.solve(right);
      const CondensedNewton::Point point{all.head(n), all.tail(m), true, 0};
      const auto same = [&](const VectorXd& x) { return (x - point.x).norm() < 1e-8 * (1 + x.norm()); };
      if (violation(p, point) < 1e-10 && std::none_of(found.begin(), found.end(), same)) found.push_back(point.x);
    }
    more = false;
    for (std::size_t i = 0; i < guess.size() && !more; ++i) {
      more = ++guess[i] < (i < bounds.size() ? 2 : 3);
      if (!more) guess[i] = 0;
    }
  }
  return found;
}

TEST(CondensedNewton, IsTheOneSolutionOfAllGuesses)
{
  for (int seed = 1; seed <= 40; ++seed) {
    const auto bounds = random_programme(seed, 8, 0, seed % 3, seed % 4), tresca = random_programme(seed, 4, 1, 2, seed % 3);
    for (const auto& p : {bounds, tresca}) {
      const auto all = brute_force(p);
      ASSERT_EQ(all.size(), 1U) << seed;
      const auto point = p.solve();
      EXPECT_TRUE(point.converged);
      EXPECT_LT((point.x - all[0]).norm(), 1e-10 * all[0].norm()) << seed;
    }
  }
}

// Coulomb's law may have several solutions; and where normal and tangent have much to do with each other, as in random matrices,
// now and then none is found.
TEST(CondensedNewton, IsAmongAllGuessesOfCoulombsLaw)
{
  int several = 0, missed = 0;
  for (int seed = 1; seed <= 150; ++seed)
    for (const double coefficient : {0.3, 1.5}) {
      auto p = random_programme(seed, 4, 1, 2, seed % 4);
      p.set.set_coefficients(std::vector<double>(4, coefficient));
      const auto all = brute_force(p);
      several += all.size() > 1;
      const auto point = p.solve();
      if (point.converged) {
        EXPECT_LT(violation(p, point), 1e-9) << seed;
        const auto same = [&](const VectorXd& x) { return (x - point.x).norm() < 1e-8 * x.norm(); };
        EXPECT_TRUE(std::any_of(all.begin(), all.end(), same)) << seed << ", one of " << all.size();
      } else if (!all.empty()) {
        ++missed;
      }
    }
  EXPECT_GT(several, 3);
  EXPECT_LT(missed, 30) << "of 300";
}

// Loads that nothing balances: pulled off, pushed beyond what friction holds.
TEST(CondensedNewton, WhatIsNotSolvableIsNotSettled)
{
  for (int seed = 1; seed <= 20; ++seed)
    for (const int tangents : {0, 1, 2})
      for (const double coefficient : {0.0, 0.5}) {
        auto p = random_programme(seed, 10, tangents, 6, 0);
        p.g = MatrixXd::Zero(tangents > 0 ? 2 : 1, p.b.size());
        for (const auto& bound : p.set.bounds()) p.g(0, bound.index) = 1;  // forces on a rigid body, along normals
        for (const auto& disc : p.set.discs()) p.g(1, disc.index[0]) = 1;  // and along the first tangents
        if (tangents > 0) p.set.set_coefficients(std::vector<double>(10, coefficient));
        const auto never = [&](double normal, double tangential) {
          p.e = Vector2d(normal, tangential).head(p.g.rows());
          const auto point = p.solve();
          EXPECT_FALSE(point.converged) << seed << ": " << tangents << " tangents, coefficient " << coefficient << ", forces "
                                        << p.e.transpose() << ", violation " << violation(p, point);
        };
        never(-1, 0);
        never(-1e-4, 0);
        if (tangents == 0) continue;
        const double most = coefficient > 0 ? coefficient * 5 : 10 * 0.3;
        never(5, 1.01 * most);
        never(5, 10 * most);
      }
}

TEST(CondensedNewton, TimesTheInverse)
{
  for (const auto& [points, free] : {std::pair{10, 15}, {10, 0}, {0, 15}}) {
    const auto p = random_programme(3, points, 2, free, 1);
    const CondensedNewton newton = p.condensed();
    const VectorXd r = Random(9).matrix(p.b.size(), 1);
    EXPECT_LT((p.a * newton.inverse_times(r) - r).norm(), 1e-10 * r.norm());
  }
}

TEST(CondensedNewton, WithoutConstraintsItIsALinearProblem)
{
  for (const int rigid : {0, 1}) {
    auto p = random_programme(3, 0, 0, 15, 0);
    if (rigid == 0) p.g = MatrixXd(0, 15), p.e = VectorXd(0);
    const auto point = p.solve();
    EXPECT_TRUE(point.converged);
    EXPECT_LT(violation(p, point), 1e-10);
  }
}

// What opens at every point leaves no force but those that G asks of unknowns without a constraint.
TEST(CondensedNewton, EverythingMayBeOpen)
{
  for (const int free : {0, 12}) {
    auto p = random_programme(4, 6, 1, free, 0);
    p.set.set_coefficients(std::vector<double>(6, 0.4));
    for (const auto& bound : p.set.bounds()) {
      p.b[bound.index] = -1e3;
      p.g.col(bound.index).setZero();
    }
    const auto point = p.solve();
    EXPECT_TRUE(point.converged);
    EXPECT_LT(violation(p, point), 1e-10);
    for (const auto& bound : p.set.bounds()) EXPECT_EQ(point.x[bound.index], 0);
  }
}

TEST(CondensedNewton, GoesOnFromAnotherElimination)
{
  for (int seed = 1; seed <= 10; ++seed) {
    constexpr Index gone = 4;  // the first of the unknowns without a constraint
    const auto p = random_programme(seed, 10, 2, 2 * gone, 2);
    const auto whole = p.solve();
    const Index left = p.b.size() - gone;
    const MatrixXd response = p.a.topLeftCorner(gone, gone).llt().solve(p.a.topRightCorner(gone, left)),
                   motion = p.a.topLeftCorner(gone, gone).llt().solve(p.g.leftCols(gone).transpose());
    std::vector<Bound> bounds;
    std::vector<Disc> discs;
    for (const auto& bound : p.set.bounds()) bounds.push_back({bound.index - static_cast<Local>(gone), bound.lower});
    for (auto disc : p.set.discs()) {
      for (auto* index : {&disc.index[0], &disc.index[1], &disc.normal}) *index -= static_cast<Local>(gone);
      discs.push_back(disc);
    }
    const FeasibleSet set(std::move(bounds), std::move(discs));
    const CondensedNewton newton(p.a.bottomRightCorner(left, left) - p.a.bottomLeftCorner(left, gone) * response,
                                 p.g.rightCols(left) - p.g.leftCols(gone) * response, p.g.leftCols(gone) * motion, set);
    const auto part =
        newton.solve(p.b.tail(left) - response.transpose() * p.b.head(gone), p.e - motion.transpose() * p.b.head(gone), set);
    ASSERT_EQ(part.converged, whole.converged) << seed;
    if (!whole.converged) continue;
    EXPECT_LT((part.x - whole.x.tail(left)).norm(), 1e-9 * whole.x.norm()) << seed;
    EXPECT_LT((part.nu - whole.nu).norm(), 1e-9 * (1 + whole.nu.norm())) << seed;
  }
}

// Two contacts at the edge of a body in a corner: what is along one is across the other, so rows come twice and how forces are
// shared out is open. The forces together are not.
TEST(CondensedNewton, RowsThatDependOnEachOther)
{
  constexpr int points = 6;
  for (int seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    // Components 2 k and 2 k + 1 of point k; unknowns 4 k and 4 k + 1: normal and tangent of the first contact, then of the
    // second.
    MatrixXd rows = MatrixXd::Zero(4 * points, 2 * points);
    std::vector<Bound> bounds;
    std::vector<Disc> discs;
    for (int k = 0; k < points; ++k) {
      rows(4 * k, 2 * k) = rows(4 * k + 1, 2 * k + 1) = rows(4 * k + 2, 2 * k + 1) = rows(4 * k + 3, 2 * k) = 1;
      for (const Local i : {4 * k, 4 * k + 2}) {
        bounds.push_back({i});
        discs.push_back({{i + 1, -1}, 0.3});
        discs.back().normal = i;
      }
    }
    const MatrixXd compliance = random.definite(2 * points, 1);
    const VectorXd pushed = VectorXd::Ones(2 * points) + 0.5 * random.matrix(2 * points, 1);
    Programme p{rows * compliance * rows.transpose(), MatrixXd::Zero(0, 4 * points), rows * pushed, VectorXd::Zero(0),
                FeasibleSet(bounds, discs)};
    p.set.set_coefficients(std::vector<double>(discs.size(), 0.3));
    const auto point = p.solve();
    EXPECT_TRUE(point.converged) << seed;
    EXPECT_LT(violation(p, point), 1e-6) << seed;
  }
}

TEST(CondensedNewton, RefusesWhatIsNotDefinite)
{
  auto p = random_programme(3, 4, 1, 5, 0);
  for (const Local i : {p.set.bounds()[0].index, Local{0}}) {  // a constrained unknown and one without
    auto a = p.a;
    a(i, i) = -1;
    try {
      CondensedNewton(a, p.g, MatrixXd::Zero(p.g.rows(), p.g.rows()), p.set);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::not_converged);
    }
  }
}

// A string of length 2 and tension 1 under the load q, a depth below it an obstacle: up to sqrt(2 depth / q) from
// its ends it hangs free, and the obstacle bears the load of what lies on it.
TEST(CondensedNewton, AStringOnAnObstacle)
{
  constexpr int n = 199;
  constexpr double h = 2.0 / (n + 1), q = 3, depth = 0.4;
  Programme p;
  p.a.resize(n, n);
  p.b.resize(n);
  std::vector<Bound> bounds;
  for (int i = 0; i < n; ++i) {
    const double x = h * (i + 1);
    for (int j = 0; j < n; ++j) p.a(i, j) = std::min(x, h * (j + 1)) * (2 - std::max(x, h * (j + 1))) / 2;
    p.b[i] = q * x * (2 - x) / 2 - depth;
    bounds.push_back({i});
  }
  p.g = MatrixXd(0, n);
  p.e = VectorXd(0);
  p.set = FeasibleSet(bounds, {});
  const auto point = p.solve();
  ASSERT_TRUE(point.converged);
  EXPECT_LT(violation(p, point), 1e-9);
  const double free = std::sqrt(2 * depth / q);
  for (int i = 0; i < n; ++i) {
    const double edge = std::min(h * (i + 1), 2 - h * (i + 1)) - free;
    EXPECT_NEAR(point.x[i], edge > 0 ? q * h : 0, (std::abs(edge) > h ? 1e-9 : 1.0) * q * h) << i;
  }
  EXPECT_NEAR(point.x.sum(), q * (2 - 2 * free), 0.01 * q);
}

// A cylinder on a half-plane in strips of constant pressure, pressed and pushed sideways: Hertz' half width and, of what sticks,
// that of Cattaneo and Mindlin, c = a sqrt(1 - Q / (mu P)). The half-plane gives way by -2 ln|x| / (pi E).
TEST(CondensedNewton, ACylinderOnAHalfPlane)
{
  constexpr int n = 200;
  constexpr double width = 0.5, h = width / n, e = 10, radius = 1, force = 0.2, coefficient = 0.4,
                   push = 0.6 * coefficient * force;
  const auto integral = [](double x) { return x == 0 ? 0 : x * std::log(std::abs(x)) - x; };
  Programme p;
  p.a = MatrixXd::Zero(2 * n, 2 * n);
  p.b = VectorXd::Zero(2 * n);
  p.g = MatrixXd::Zero(2, 2 * n);
  std::vector<Bound> bounds;
  std::vector<Disc> discs;
  for (int i = 0; i < n; ++i) {
    const double x = h * (i + 0.5) - width / 2;
    for (int j = 0; j < n; ++j) {
      const double d = h * (i - j);
      p.a(2 * i, 2 * j) = p.a(2 * i + 1, 2 * j + 1) =
          -2 / (std::numbers::pi * e * h) * (integral(d + h / 2) - integral(d - h / 2));
    }
    p.b[2 * i] = -x * x / (2 * radius);
    p.g(0, 2 * i) = p.g(1, 2 * i + 1) = 1;
    bounds.push_back({2 * i});
    discs.push_back({{2 * i + 1, -1}});
    discs.back().normal = 2 * i;
    discs.back().coefficient = coefficient;
  }
  p.e = Vector2d(force, push);
  p.set = FeasibleSet(bounds, discs);
  const auto point = p.solve();
  ASSERT_TRUE(point.converged);
  EXPECT_LT(violation(p, point), 1e-9);
  const double a = std::sqrt(4 * force * radius / (std::numbers::pi * e)), c = a * std::sqrt(1 - push / (coefficient * force));
  ASSERT_LT(a, 0.45 * width);
  int closed = 0, sticks = 0;
  for (int i = 0; i < n; ++i) {
    const double x = h * (i + 0.5) - width / 2, normal = point.x[2 * i] / h, tangential = point.x[2 * i + 1] / h;
    closed += normal > 0;
    sticks += normal > 0 && std::abs(tangential) < (1 - 1e-9) * coefficient * normal;
    const double peak = e / (2 * radius) * a;
    const auto ellipse = [&](double half) { return e / (2 * radius) * std::sqrt(std::max(half * half - x * x, 0.0)); };
    EXPECT_NEAR(normal, ellipse(a), std::abs(std::abs(x) - a) > 3 * h ? 0.01 * peak : 0.2 * peak);
    EXPECT_NEAR(tangential / coefficient, ellipse(a) - ellipse(c),
                std::min(std::abs(std::abs(x) - a), std::abs(std::abs(x) - c)) > 3 * h ? 0.01 * peak : 0.2 * peak);
  }
  EXPECT_NEAR(closed * h, 2 * a, 3 * h);
  EXPECT_NEAR(sticks * h, 2 * c, 3 * h);
}

// A belt of n bars around a drum, drawn over it at one end by `drawn`, with a given force on the other: Eytelwein. Its bars'
// forces are unknowns without a constraint; what balances them at the nodes are rows of G.
Programme belt(int n, double angle, double coefficient, double drawn, double compliance)
{
  const double part = angle / n, slack = 1;
  const Index size = n + 1 + 2 * n;  // forces of n + 1 bars; normal and tangential force at the n nodes between them
  Programme p;
  p.a = MatrixXd::Zero(size, size);
  p.b = VectorXd::Zero(size);
  p.g = MatrixXd::Zero(2 * n + 1, size);
  p.e = VectorXd::Zero(2 * n + 1);
  std::vector<Bound> bounds;
  std::vector<Disc> discs;
  for (Index j = 0; j <= n; ++j) p.a(j, j) = part;
  p.b[0] = drawn;
  for (int i = 0; i < n; ++i) {
    const Local at = n + 1 + 2 * i;
    p.a(at, at) = p.a(at + 1, at + 1) = compliance * part;
    p.g(2 * i, at) = p.g(2 * i + 1, at + 1) = -1;
    p.g(2 * i, i) = p.g(2 * i, i + 1) = std::sin(part / 2);
    p.g(2 * i + 1, i) = std::cos(part / 2);
    p.g(2 * i + 1, i + 1) = -std::cos(part / 2);
    bounds.push_back({at});
    discs.push_back({{at + 1, -1}});
    discs.back().normal = at;
    discs.back().coefficient = coefficient;
  }
  p.g(2 * n, n) = 1;
  p.e[2 * n] = slack;
  p.set = FeasibleSet(bounds, discs);
  return p;
}

TEST(CondensedNewton, ABeltOnADrum)
{
  for (const double compliance : {1e-4, 1e-2, 1.0})  // of a point of the drum over that of a bar
    for (const double angle : {1.0, 3.0, 6.0})
      for (const double coefficient : {0.1, 0.5, 1.0}) {
        constexpr int n = 100;
        const double taut = std::exp(coefficient * angle), half = coefficient * std::tan(angle / n / 2);
        const auto p = belt(n, angle, coefficient, 10 * taut * angle, compliance);
        const auto point = p.solve();
        EXPECT_TRUE(point.converged) << "angle " << angle << ", coefficient " << coefficient << ", compliance " << compliance;
        EXPECT_LT(violation(p, point), 1e-9);
        EXPECT_NEAR(point.x[0] / std::pow((1 + half) / (1 - half), n), 1, 1e-6);
        EXPECT_NEAR(point.x[0] / taut, 1, 0.01);
        if (coefficient * angle > 1) continue;
        // Drawn less, it slips from both ends to a point between.
        const auto less = belt(n, angle, coefficient, 0.2 * taut, compliance);
        const auto partly = less.solve();
        EXPECT_TRUE(partly.converged) << "angle " << angle << ", coefficient " << coefficient << ", compliance " << compliance;
        EXPECT_LT(violation(less, partly), 1e-9);
      }
}

// Some hundred rows: no piece is the whole of it.
TEST(CondensedNewton, MatricesOfSeveralPieces)
{
  auto p = random_programme(5, 150, 2, 330, 4);
  const CondensedNewton newton = p.condensed();
  const auto point = newton.solve(p.b, p.e, p.set);
  EXPECT_TRUE(point.converged);
  EXPECT_LT(violation(p, point), 1e-9);
  const VectorXd r = Random(6).matrix(p.a.rows(), 1);
  EXPECT_LT((p.a * newton.inverse_times(r) - r).norm(), 1e-9 * r.norm());
  for (const Index at : {p.a.rows() - 1, p.a.rows() / 2}) {  // of the second part without a constraint, and of contact
    auto indefinite = p.a;
    indefinite(at, at) = -1;
    try {
      const CondensedNewton factorized(indefinite, p.g, MatrixXd::Zero(p.g.rows(), p.g.rows()), p.set);
      ADD_FAILURE() << at;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::not_converged) << error.what();
    }
  }
}

TEST(CondensedNewton, EndsIfItIsToldTo)
{
  const auto p = random_programme(5, 20, 2, 20, 4);
  const CondensedNewton newton = p.condensed();
  const auto status = [](const auto& work) {
    request_stop(SIGTERM);
    auto found = ExitStatus::solved;
    try {
      work();
    } catch (const Error& error) {
      found = error.status();
    }
    request_stop(0);
    return found;
  };
  EXPECT_EQ(status([&] { newton.solve(p.b, p.e, p.set); }), ExitStatus::interrupted);
  EXPECT_EQ(status([&] { p.condensed(); }), ExitStatus::interrupted);
  EXPECT_TRUE(newton.solve(p.b, p.e, p.set).converged);
}

}  // namespace
}  // namespace mortise::qp
