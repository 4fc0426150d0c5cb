// The direct solution where a programme is at its limits: nothing to constrain, everything open, rows that depend on each other.
#include <gtest/gtest.h>

#include <csignal>

#include "base/error.hpp"
#include "base/interruption.hpp"
#include "dense_programme.hpp"

namespace mortise::qp {
namespace {

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

// A body between two walls with play, pressed against the first: closed both, both pull, so that next nothing holds the body.
// Other bodies are held by what an elimination before has left.
TEST(CondensedNewton, ABodyThatAGuessSetsFree)
{
  const MatrixXd a = MatrixXd::Identity(2, 2), g{{0, 0}, {1, -1}, {0, 0}};
  const MatrixXd c = Eigen::Vector3d(1, 0, 2).asDiagonal();
  const VectorXd b = Vector2d(0, -4), e = Eigen::Vector3d(0, 1, 0);
  const FeasibleSet set({{0}, {1}}, {});
  const auto point = CondensedNewton(a, g, c, set).solve(b, e, set);
  EXPECT_TRUE(point.converged);
  EXPECT_NEAR(point.x[0], 1, 1e-12);
  EXPECT_NEAR(point.x[1], 0, 1e-12);
  EXPECT_NEAR(point.nu[1], -1, 1e-12);
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
    MatrixProgramme p{rows * compliance * rows.transpose(), MatrixXd::Zero(0, 4 * points), rows * pushed, VectorXd::Zero(0),
                      FeasibleSet(bounds, discs)};
    p.set.set_coefficients(std::vector<double>(discs.size(), 0.3));
    const auto point = p.solve();
    EXPECT_TRUE(point.converged) << seed;
    EXPECT_LT(violation(p, point), 1e-6) << seed;
  }
}

// Bonds round a common edge: a row without a constraint comes three times, and its force is shared out evenly.
TEST(CondensedNewton, RowsWithoutAConstraintThatDependOnEachOther)
{
  for (int seed = 1; seed <= 20; ++seed) {
    const auto once = random_programme(seed, 6, 1, 10, 0);
    const Index n = once.b.size();
    MatrixXd copies(n + 2, n);
    copies << MatrixXd::Identity(n, n), MatrixXd::Identity(n, n).bottomRows(1), MatrixXd::Identity(n, n).bottomRows(1);
    const MatrixProgramme p{copies * once.a * copies.transpose(), once.g * copies.transpose(), copies * once.b, once.e, once.set};
    const auto condensed = p.condensed();
    EXPECT_TRUE(condensed.separated());
    const auto expected = once.solve(), point = condensed.solve(p.b, p.e, p.set);
    ASSERT_TRUE(expected.converged && point.converged) << seed;
    const double size = expected.x.norm();
    EXPECT_LT((point.x.head(n - 1) - expected.x.head(n - 1)).norm(), 1e-5 * size) << seed;
    for (Index copy = n - 1; copy < n + 2; ++copy) EXPECT_NEAR(point.x[copy], expected.x[n - 1] / 3, 1e-5 * size) << seed;
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

// So many that factors of one guess serve the next ones, by steps of GMRES.
TEST(CondensedNewton, ManyUnknowns)
{
  constexpr int points = 600;
  for (const double coefficient : {0.0, 0.3}) {
    auto p = random_programme(7, points, 2, 40, 4);
    p.a.diagonal().array() += 1;
    for (const auto& bound : p.set.bounds()) p.b[bound.index] = std::abs(p.b[bound.index]) + 1;
    p.set.set_coefficients(std::vector<double>(points, coefficient));
    const auto point = p.solve();
    EXPECT_TRUE(point.converged);
    EXPECT_LT(violation(p, point), 1e-9) << coefficient;
    Census census;
    census.add(p, point.x);
    EXPECT_GT(census.closed, points / 2) << coefficient;
    EXPECT_GT(census.sticks, points / 10) << coefficient;
    EXPECT_GT(census.slips, points / 10) << coefficient;
  }
}

// Bodies that were moved and carry nothing, as those of a joint that is loosened: x is rounding, and so are all states.
TEST(CondensedNewton, NoForceIsLeft)
{
  for (const double coefficient : {0.0, 0.3})
    for (int seed = 1; seed <= 20; ++seed) {
      auto p = random_programme(seed, 40, 2, 20, 6);
      p.set.set_coefficients(std::vector<double>(40, coefficient));
      p.e.setZero();
      const VectorXd moved = VectorXd::LinSpaced(p.g.rows(), 1, 2);
      p.b = p.g.transpose() * moved;
      const auto point = p.solve();
      EXPECT_TRUE(point.converged) << seed;
      EXPECT_LT(point.x.norm(), 1e-10 * p.b.norm()) << seed;
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
