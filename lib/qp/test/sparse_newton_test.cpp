// The direct solution by sparse matrices against that by dense ones, on programmes that are the same.
#include "qp/sparse_newton.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "../src/linear_factor.hpp"
#include "base/error.hpp"
#include "dense_programme.hpp"

namespace mortise::qp {
namespace {

// A chain of points with springs between them that press against something: x, y and z of point i are the unknowns 3 i, 3 i + 1
// and 3 i + 2 of K. Where its ends are not held it has a motion along each axis that it feels something of.
struct Chain {
  static constexpr int points = 24, n = 3 * points;
  SparseMatrices matrices;
  VectorXd f, c;
  FeasibleSet set;

  Chain(int seed, int tangents, bool held, double coefficient, double radius)
  {
    Random random(seed);
    std::vector<Eigen::Triplet<double>> k, b;
    const auto join = [&](int i, int j, double stiffness) {
      k.emplace_back(i, i, stiffness);
      if (j < 0) return;
      k.emplace_back(j, j, stiffness);
      k.emplace_back(std::max(i, j), std::min(i, j), -stiffness);
    };
    const VectorXd stiffness = random.matrix(2 * n, 1).cwiseAbs();
    for (int i = 0; i + 3 < n; ++i) join(i, i + 3, 1 + stiffness[i]);
    for (int i = 0; i + 6 < n; ++i) join(i, i + 6, 0.5 * stiffness[n + i]);
    if (held)
      for (int i = 0; i < 3; ++i) join(i, -1, 2), join(n - 1 - i, -1, 2);
    if (!held && tangents < 2) join(2, -1, 2);  // what no row feels
    matrices.k.resize(n, n);
    matrices.k.setFromTriplets(k.begin(), k.end());
    std::vector<Bound> bounds;
    std::vector<Disc> discs;
    const int each = 1 + tangents;
    for (int i = 0; i < points; ++i) {
      for (int t = 0; t < each; ++t) b.emplace_back(i * each + t, 3 * i + t, 1);
      bounds.push_back({i * each});
      if (tangents == 0) continue;
      discs.push_back({{i * each + 1, tangents == 2 ? i * each + 2 : -1}, radius});
      discs.back().normal = i * each;
      discs.back().coefficient = coefficient;
    }
    matrices.b.resize(points * each, n);
    matrices.b.setFromTriplets(b.begin(), b.end());
    matrices.s = VectorXd::Zero(points * each);
    set = FeasibleSet(bounds, discs);
    f = 0.3 * random.matrix(n, 1);
    for (int i = 0; i < points; ++i) {
      f[3 * i] += 0.5;  // pressed
      for (int t = tangents; t < 2; ++t) f[3 * i + 1 + t] = 0;
    }
    if (!held)
      for (int t = 1; t < 3; ++t) {
        double mean = 0;
        for (int i = 0; i < points; ++i) mean += f[3 * i + t] / points;
        for (int i = 0; i < points; ++i) f[3 * i + t] -= mean;
      }
    c = VectorXd::Zero(points * each);
    for (int i = 0; i < points; ++i) c[i * each] = 0.1 * std::abs(random.matrix(1, 1)(0, 0));
  }

  VectorXd forces(const VectorXd& u) const { return matrices.k.selfadjointView<Eigen::Lower>() * u; }

  // The same with K_r = K + r N, N a projector onto the motions, which is dense.
  MatrixProgramme dense() const
  {
    const SparseMatrix whole = matrices.k.selfadjointView<Eigen::Lower>();
    const MatrixXd k = whole;
    MatrixXd r(n, 0);
    for (int axis = 0; axis < 3; ++axis) {
      VectorXd motion = VectorXd::Zero(n);
      for (int i = axis; i < n; i += 3) motion[i] = 1 / std::sqrt(points);
      if ((k * motion).norm() > 1e-9) continue;
      r.conservativeResize(n, r.cols() + 1);
      r.rightCols(1) = motion;
    }
    const MatrixXd b = matrices.b;
    const MatrixXd inverse = (k + r * r.transpose()).llt().solve(MatrixXd::Identity(n, n));
    MatrixProgramme p;
    p.a = b * inverse * b.transpose();
    p.a += MatrixXd(matrices.s.asDiagonal());
    p.b = b * inverse * f - c;
    p.g = r.transpose() * b.transpose();
    p.e = r.transpose() * f;
    p.set = set;
    return p;
  }
};

class OfEveryLaw : public testing::TestWithParam<std::tuple<int, std::pair<double, double>, bool>> {};
INSTANTIATE_TEST_SUITE_P(LawsAndMotions, OfEveryLaw,
                         testing::Combine(testing::Values(1, 2),
                                          testing::Values(std::pair{0.0, 0.1}, std::pair{0.3, 0.0}, std::pair{1.0, 0.0}),
                                          testing::Bool()));

void expect_as_dense(const Chain& chain, int seed, Census& census)
{
  const auto found = SparseNewton(chain.matrices).solve(chain.f, chain.c, chain.set);
  ASSERT_TRUE(found.converged) << seed;
  const auto p = chain.dense();
  const auto expected = p.solve();
  ASSERT_TRUE(expected.converged) << seed;
  EXPECT_LT((found.x - expected.x).norm(), 1e-7 * expected.x.norm()) << seed;
  // A x - b + G'nu = s tells nu; where all slips, motions are not the dense ones.
  CondensedNewton::Result point{found.x, VectorXd::Zero(p.g.rows())};
  if (p.g.rows() > 0) point.nu = (p.g * p.g.transpose()).llt().solve(p.g * (found.reaction - p.a * found.x + p.b));
  EXPECT_LT(violation(p, point), 1e-7) << seed;
  EXPECT_LT((chain.forces(found.nu) + chain.matrices.b.transpose() * found.x - chain.f).norm(), 1e-9 * chain.f.norm());
  census.add(p, found.x);
}

TEST_P(OfEveryLaw, IsTheDenseSolution)
{
  const auto& [tangents, law, held] = GetParam();
  Census census;
  for (int seed = 1; seed <= 8; ++seed)
    expect_as_dense(Chain(seed, tangents, held, law.first, law.first > 0 ? 0 : law.second), seed, census);
  EXPECT_GT(census.open, 10);
  EXPECT_GT(census.closed, 40);
  EXPECT_GT(census.sticks + census.slips, 40);
  EXPECT_GT(census.slips, 5);
}

TEST(SparseNewton, IsTheDenseSolutionWithoutFriction)
{
  Census census;
  for (int seed = 1; seed <= 8; ++seed) expect_as_dense(Chain(seed, 0, true, 0, 0), seed, census);
  EXPECT_GT(census.open, 10);
  EXPECT_GT(census.closed, 40);
}

// Rows that are in no bound or disc are equations, and rows may give way by themselves.
TEST(SparseNewton, HasEquationsAndCompliance)
{
  Chain chain(3, 2, true, 0.3, 0);
  std::vector<Disc> discs(chain.set.discs().begin(), chain.set.discs().end() - 4);
  chain.set = FeasibleSet({chain.set.bounds().begin(), chain.set.bounds().end() - 4}, discs);
  chain.matrices.s.setConstant(0.2);
  Census census;
  expect_as_dense(chain, 3, census);
}

TEST(SparseNewton, GoesOnFromASolutionNearby)
{
  Chain chain(5, 2, true, 0.5, 0);
  const SparseNewton newton(chain.matrices);
  const auto first = newton.solve(chain.f, chain.c, chain.set);
  ASSERT_TRUE(first.converged);
  chain.c.array() += 1e-7;
  const auto next = newton.solve(chain.f, chain.c, chain.set, &first);
  EXPECT_TRUE(next.converged);
  EXPECT_LT(next.steps, 4);
  const auto p = chain.dense();
  EXPECT_LT((next.x - p.solve().x).norm(), 1e-7 * next.x.norm());
}

TEST(SparseNewton, SaysWhereNothingBalancesTheLoads)
{
  Chain chain(1, 2, false, 0.3, 0);
  for (int i = 0; i < Chain::points; ++i) chain.f[3 * i + 1] += 1;
  EXPECT_FALSE(SparseNewton(chain.matrices).solve(chain.f, chain.c, chain.set).converged);
}

TEST(SparseInverse, IsTheInverseOfTheCompliance)
{
  const Chain chain(2, 2, true, 0.3, 0);
  const SparseInverse inverse(chain.matrices);
  const auto p = chain.dense();
  const VectorXd x = VectorXd::LinSpaced(p.a.rows(), -1, 2);
  const auto found = inverse.solve(p.a * x, VectorXd::Zero(Chain::n));
  EXPECT_LT((found.x - x).norm(), 1e-9 * x.norm());
  const VectorXd f = VectorXd::LinSpaced(Chain::n, 1, 3);
  const auto loaded = inverse.solve(p.a * x, f);
  EXPECT_LT((chain.forces(loaded.u.cast<double>()) - f - chain.matrices.b.transpose() * loaded.x).norm(), 1e-9 * f.norm());
  EXPECT_LT((chain.matrices.b * loaded.u.cast<double>() - p.a * x).norm(), 1e-9 * (p.a * x).norm());
}

// Two bodies, each of points with two faces that a stiffness of `across` joins; the means of these are a chain with springs of 1
// whose ends are held. They press against each other with a face each: A = 2 L^-1 + 1 / (2 across), L of a chain.
struct ThinPair {
  static constexpr int points = 20, unknowns = 4 * points;
  SparseMatrices matrices;
  MatrixXd chain = 2 * MatrixXd::Identity(points, points);  // L

  explicit ThinPair(double across)
  {
    for (int i = 0; i + 1 < points; ++i) chain(i, i + 1) = chain(i + 1, i) = -1;
    const MatrixXd stiff = across * MatrixXd::Identity(points, points);
    MatrixXd k = MatrixXd::Zero(unknowns, unknowns);
    for (const int body : {0, 2}) {
      auto own = k.block(body * points, body * points, 2 * points, 2 * points);
      own << chain / 4 + stiff, chain / 4 - stiff, chain / 4 - stiff, chain / 4 + stiff;
    }
    matrices.k = MatrixXd(k.triangularView<Eigen::Lower>()).sparseView();
    matrices.b.resize(points, unknowns);
    for (int i = 0; i < points; ++i) {
      matrices.b.insert(i, i) = 1;
      matrices.b.insert(i, 2 * points + i) = -1;
    }
    matrices.s = VectorXd::Zero(points);
  }
  MatrixXd compliance() const { return 2 * chain.llt().solve(MatrixXd::Identity(points, points)); }
  double missing(const VectorXd& x, const ExtendedVector& u, const VectorXd& f) const
  {
    return lacking_forces(matrices, x, u, -f).norm();
  }
};

// What is soft is 1e10 times as soft as what is stiff: a sum with constraints that are stiffer still has lost it.
TEST(SparseInverse, KeepsWhatIsSoftWithNothingEliminated)
{
  const ThinPair thin(1e10);
  const VectorXd r = VectorXd::LinSpaced(ThinPair::points, 1, 3), expected = thin.chain * r / 2;
  const VectorXd nothing = VectorXd::Zero(ThinPair::unknowns);
  const auto found = SparseInverse(thin.matrices, true).solve(r, nothing);
  const double error = (found.x - expected).norm();
  EXPECT_LT(error, 1e-6 * expected.norm());
  EXPECT_LT(thin.missing(-found.x, found.u, nothing), 1e-7 * expected.norm());
  double other = std::numeric_limits<double>::infinity();
  try {
    other = (SparseInverse(thin.matrices).solve(r, nothing).x - expected).norm();
  } catch (const Error& lost) {
    EXPECT_EQ(lost.status(), ExitStatus::not_converged);
  }
  EXPECT_GT(other, 100 * error);
}

// Where thin bodies touch is told by what is soft in them. Forces balance to figures of their own, though the last one of u makes
// more of the stiffness.
TEST(SparseNewton, FindsContactOfThinBodies)
{
  const ThinPair thin(1e10);
  constexpr int n = ThinPair::points;
  VectorXd f = VectorXd::Zero(ThinPair::unknowns), c(n);
  for (int i = 0; i < n; ++i) f[n + i] = 0.2 + 0.02 * i;
  for (int i = 0; i < n; ++i) c[i] = 3 + (i % 3);
  std::vector<Bound> bounds;
  for (int i = 0; i < n; ++i) bounds.push_back({i});
  const FeasibleSet set(bounds, {});
  const auto found = SparseNewton(thin.matrices, true).solve(f, c, set);
  ASSERT_TRUE(found.converged);
  MatrixProgramme p;
  p.a = thin.compliance();
  p.b = thin.chain.llt().solve(f.segment(n, n)) - c;
  p.g = MatrixXd(0, n);
  p.e = VectorXd(0);
  p.set = set;
  const auto expected = p.solve();
  ASSERT_TRUE(expected.converged);
  Census census;
  census.add(p, expected.x);
  EXPECT_GT(census.open, 3);
  EXPECT_GT(census.closed, 3);
  EXPECT_LT((found.x - expected.x).norm(), 1e-6 * expected.x.norm());
  ASSERT_EQ(found.nu_rest.size(), ThinPair::unknowns);
  const ExtendedVector u = found.nu.cast<long double>();
  const double missing = thin.missing(found.x, u + found.nu_rest.cast<long double>(), f);
  EXPECT_LT(missing, 1e-6);
  EXPECT_GT(thin.missing(found.x, u, f), 30 * missing);
}

}  // namespace
}  // namespace mortise::qp
