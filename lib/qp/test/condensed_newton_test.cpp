// The direct solution against the conditions that it has to fulfil, and against all guesses tried one by one.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "dense_programme.hpp"

namespace mortise::qp {
namespace {

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

// States that another way has come to: if they are right it takes a guess or two, if they are not it is given up.
TEST(CondensedNewton, FromGuessedStates)
{
  for (int seed = 1; seed <= 20; ++seed) {
    const auto p = random_programme(seed, 20, 2, 10, 2);
    const auto newton = p.condensed();
    const auto solution = newton.solve(p.b, p.e, p.set);
    ASSERT_TRUE(solution.converged) << seed;
    auto guess = solution;
    guess.converged = false;
    guess.nu.setZero();
    const auto again = newton.solve(p.b, p.e, p.set, &guess);
    EXPECT_TRUE(again.converged) << seed;
    EXPECT_LE(again.steps, 6) << seed;
    EXPECT_LT((again.x - solution.x).norm(), 1e-8 * solution.x.norm()) << seed;
    guess.x.setZero();
    guess.reaction.setConstant(1);  // open everywhere
    const auto wrong = newton.solve(p.b, p.e, p.set, &guess);
    EXPECT_FALSE(wrong.converged) << seed;
    EXPECT_EQ(wrong.steps, 1) << seed;
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
std::vector<VectorXd> brute_force(const MatrixProgramme& p)
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
      const CondensedNewton::Result point{all.head(n), all.tail(m), true, 0};
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
  EXPECT_LT(missed, 5) << "of 300";
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

// Points under 1 each on a plane, pushed along it: friction holds 0.3 a point. With more they slide on, forces as they are then;
// what is pulled off is no slide.
TEST(CondensedNewton, SlidesOnWhereFrictionFallsShort)
{
  for (const int tangents : {1, 2})
    for (const double push : {0.29, 0.2999, 0.3001, 0.31, 3.0}) {
      const Index points = 20, each = 1 + tangents, n = points * each;
      Random random(7);
      MatrixProgramme p;
      p.a = random.definite(n, 0.5);
      for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j)
          if ((i % each == 0) != (j % each == 0)) p.a(i, j) *= 0.02;
      p.b = VectorXd::Zero(n);
      p.g = MatrixXd::Zero(each, n);
      p.e = VectorXd::Zero(each);
      std::vector<Bound> bounds;
      std::vector<Disc> discs;
      for (Index i = 0; i < points; ++i) {
        const auto at = static_cast<Local>(i * each);
        for (Index k = 0; k < each; ++k) p.g(k, at + k) = 1;
        bounds.push_back({at});
        discs.push_back({{at + 1, tangents == 2 ? at + 2 : -1}, 0, {0, 0}, at, 0.3});
      }
      p.e[0] = static_cast<double>(points);
      p.e[each - 1] = push * static_cast<double>(points);
      p.set = FeasibleSet(std::move(bounds), std::move(discs));
      const auto point = p.solve();
      EXPECT_EQ(point.converged, push < 0.3) << tangents << " " << push;
      EXPECT_EQ(point.slides, push > 0.3) << tangents << " " << push;
      if (push < 0.3) {
        EXPECT_LT(violation(p, point), 1e-9) << tangents << " " << push;
      } else {
        EXPECT_NEAR(point.x.dot(p.g.row(each - 1)), 0.3 * static_cast<double>(points), 1e-6) << push;
      }
      p.e[0] = -1;
      const auto pulled = p.solve();
      EXPECT_FALSE(pulled.converged || pulled.slides);
    }
}

}  // namespace
}  // namespace mortise::qp
