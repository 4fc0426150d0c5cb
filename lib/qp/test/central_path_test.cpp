// The interior point method of the direct solution alone, where another program, formulas and the conditions of a solution say
// what it has to find.
#include "../src/central_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <span>

#include "../src/condensed_programme.hpp"
#include "../src/dense_system.hpp"
#include "dense_programme.hpp"

namespace mortise::qp {
namespace {

// With the compliance of each unknown if the others are fixed, as CondensedNewton has it.
CondensedMatrices matrices_of(const MatrixProgramme& p, MatrixXd c)
{
  return {p.a, p.g, std::move(c), p.a.inverse().diagonal().cwiseInverse()};
}

// Some steps from nowhere, until nothing becomes nearer.
CondensedNewton::Result walk(const CondensedMatrices& matrices, const MatrixProgramme& p, double enough = 1e-15, int most = 100)
{
  const CondensedProgramme programme(matrices, p.a.llt(), p.set, p.b, p.e);
  auto path = programme.path_from(VectorXd::Ones(p.b.size()), VectorXd::Zero(p.e.size()));
  int steps = 0;
  while (steps < most && path.distance().product > enough && path.advance()) ++steps;
  return {path.x(), path.nu(), path.distance().product <= enough, steps};
}

MatrixProgramme contact_alone(int seed, int points, int tangents, int rigid)
{
  return random_programme(seed, points, tangents, 0, rigid);
}

// Eight points with discs of every state, a motion that a spring holds and one that nothing does. What is compared with are the
// figures of Clarabel 0.11 (a solver of conic programmes), to 1e-6.
TEST(CentralPath, FiguresOfClarabel)
{
  constexpr int points = 8, n = 3 * points;
  MatrixProgramme p;
  p.a = MatrixXd::NullaryExpr(n, n, [](Index i, Index j) {
    const auto x = static_cast<double>(i), y = static_cast<double>(j);
    return (i == j ? 0.01 : 0) + std::exp(-std::abs(x - y) / 5) + 100 * std::cos(x) * std::cos(y);
  });
  p.b = VectorXd::NullaryExpr(n, [](Index i) { return std::sin(3.0 * static_cast<double>(i)) + (i % 3 == 0 ? 1 : 0); });
  p.g = MatrixXd::Zero(2, n);
  p.e = Vector2d(4, 0.3);
  std::vector<Bound> bounds;
  std::vector<Disc> discs;
  for (Local i = 0; i < points; ++i) {
    p.g(0, 3 * i) = 1;
    p.g(1, 3 * i + 1) = i % 2 == 0 ? 1 : -1;
    bounds.push_back({3 * i});
    discs.push_back({{3 * i + 1, 3 * i + 2}, 0.05 + 0.15 * i});
  }
  p.set = FeasibleSet(bounds, discs);
  constexpr std::array<double, n> expected{1.138757011, -0.036973624, -0.033659339, 0.000000000, -0.151183942, 0.130932867,
                                           0.000000000, -0.032252681, -0.348510781, 0.836668617, -0.434404744, 0.247573259,
                                           0.000000000, 0.076338108,  -0.645501738, 1.385154101, -0.783194218, 0.163115960,
                                           0.496044371, -0.372446321, -0.323481640, 0.209083785, 0.703448387,  -0.845671548};
  const auto point = walk(matrices_of(p, Vector2d(0.1, 0).asDiagonal()), p);
  EXPECT_TRUE(point.converged);
  EXPECT_LT(point.steps, 25);
  EXPECT_LT((point.x - Eigen::Map<const VectorXd>(expected.data(), n)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(0.5 * point.x.dot(p.a * point.x) - p.b.dot(point.x), -7.16326141, 1e-7);
  EXPECT_NEAR(point.nu[0], 0.65707886, 1e-6);
}

// Convex, so that the conditions hold at one point alone.
TEST(CentralPath, ConvexProgrammesAtEverySeed)
{
  for (const int tangents : {0, 1, 2})
    for (int seed = 1; seed <= 30; ++seed) {
      const auto p = contact_alone(seed, 12, tangents, seed % 3);
      const auto point = walk(matrices_of(p, MatrixXd::Zero(p.g.rows(), p.g.rows())), p);
      EXPECT_TRUE(point.converged) << seed;
      EXPECT_LT(point.steps, 40) << seed;
      EXPECT_LT(violation(p, point), 1e-6) << seed << " " << tangents;
    }
}

TEST(CentralPath, CoulombConesAtEverySeed)
{
  int missed = 0;
  for (const int tangents : {1, 2})
    for (const double coefficient : {0.05, 0.3, 0.8, 2.0})
      for (int seed = 1; seed <= 30; ++seed) {
        auto p = contact_alone(seed, 12, tangents, seed % 3);
        p.set.set_coefficients(std::vector<double>(12, coefficient));
        p.a.diagonal().array() += 1;
        const auto point = walk(matrices_of(p, MatrixXd::Zero(p.g.rows(), p.g.rows())), p);
        missed += !(violation(p, point) < 1e-6);
      }
  EXPECT_LE(missed, 2) << "of 240";
}

// Radius 0 pins at the centre, an infinite one does nothing.
TEST(CentralPath, DiscsOfEveryRadiusAndCentre)
{
  for (const int tangents : {1, 2}) {
    auto p = contact_alone(5, 12, tangents, 1);
    std::vector<Disc> discs(p.set.discs().begin(), p.set.discs().end());
    discs[0].radius = discs[1].radius = 0;
    discs[1].centre = {0.1, 0};
    discs[2].radius = discs[3].radius = std::numeric_limits<double>::infinity();
    discs[4].centre = {0.5, tangents == 2 ? -0.25 : 0};
    p.set = FeasibleSet({p.set.bounds().begin(), p.set.bounds().end()}, discs);
    const auto point = walk(matrices_of(p, MatrixXd::Zero(1, 1)), p);
    EXPECT_TRUE(point.converged);
    EXPECT_EQ(from_centre(discs[1], point.x).norm(), 0);
    for (auto& disc : discs) disc.radius = std::min(disc.radius, 1e3);
    p.set = FeasibleSet({p.set.bounds().begin(), p.set.bounds().end()}, discs);
    EXPECT_LT(violation(p, point), 1e-6);
  }
}

// Predictions that are off by a part of the forces, as those by iterations are.
class RoughSystem : public DenseSystem {
 public:
  using DenseSystem::DenseSystem;
  std::unique_ptr<PathFactor> factor(std::span<const Stiffening> entries, std::span<const Local> pinned,
                                     bool symmetric) const override
  {
    return std::make_unique<Factor>(DenseSystem::factor(entries, pinned, symmetric));
  }

 private:
  struct Factor : PathFactor {
    explicit Factor(std::unique_ptr<PathFactor> given) : exact(std::move(given)) {}
    Step solve(const VectorXd& forces, const VectorXd& lack, bool roughly) const override
    {
      auto step = exact->solve(forces, lack, roughly);
      if (roughly) step.x.array() += 1e-3 * forces.norm();
      return step;
    }
    std::unique_ptr<PathFactor> exact;
  };
};

TEST(CentralPath, RoughPredictionsLeaveMotionsAlone)
{
  for (int seed = 1; seed <= 10; ++seed) {
    const auto p = contact_alone(seed, 12, 0, 2);
    const auto matrices = matrices_of(p, MatrixXd::Zero(2, 2));
    const Eigen::LLT<MatrixXd> factor = p.a.llt();
    const RoughSystem system(matrices, factor, p.set);
    CentralPath path(system, p.set, {}, p.b, p.e, VectorXd::Ones(p.b.size()), VectorXd::Zero(2));
    const auto first = path.distance();
    for (int step = 0; step < 40 && path.distance().product > 1e-8 * first.product; ++step) path.advance();
    EXPECT_LT(path.distance().motions, 1e-8 * first.motions) << seed;
  }
}

TEST(CentralPath, LeadsNowhereWhereNothingBalances)
{
  auto p = contact_alone(3, 6, 2, 0);
  p.g = MatrixXd::Zero(1, p.b.size());
  for (const auto& bound : p.set.bounds()) p.g(0, bound.index) = 1;
  p.e = VectorXd::Constant(1, -1);  // pulls
  EXPECT_FALSE(walk(matrices_of(p, MatrixXd::Zero(1, 1)), p, 1e-15, 200).converged);
}

}  // namespace
}  // namespace mortise::qp
