// The dual problem of a cube cut into eight, glued and prescribed on one face: its rows, its operator, and its solution against a
// direct solve.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "cube.hpp"
#include "feti/displacements.hpp"
#include "feti/rigid_modes.hpp"
#include "qp/smalse.hpp"

namespace mortise::feti {
namespace {

TEST(DualProblem, RowsAreOrthonormalInTheStiffness)
{
  const Cube cube(1e6, true, MPI_COMM_SELF);
  const JumpOperator jump(cube.decomposition, *cube.directory, cube.interface, cube.constraints.prescribed, {}, {}, cube.comm);
  int unknowns = 0;
  for (const auto& w : cube.system.nodal_stiffness) unknowns += 3 * static_cast<int>(w.size());
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(jump.rows()->getGlobalNumElements()), unknowns);
  int base = 0;
  for (std::size_t s = 0; s < jump.blocks().size(); ++s) {
    const auto& block = jump.blocks()[s];
    for (std::size_t r = 0; r < block.row.size(); ++r)
      for (std::size_t i = block.offset[r]; i < block.offset[r + 1]; ++i)
        b(block.row[r], base + block.unknown[i]) =
            block.coefficient[i] / std::sqrt(cube.system.nodal_stiffness[s][static_cast<std::size_t>(block.unknown[i] / 3)]);
    base += block.size;
  }
  EXPECT_LT((b * b.transpose() - Eigen::MatrixXd::Identity(b.rows(), b.rows())).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DualProblem, OperatorIsSymmetricAndAdjoint)
{
  const Cube cube(100, true);
  const auto problem = cube.problem();
  const auto map = problem.hessian().getDomainMap();
  Vector x(map), y(map), fx(map), fy(map);
  for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i) {
    view(x)[i] = std::sin(static_cast<double>(map->getGlobalElement(i)));
    view(y)[i] = std::cos(3.0 * static_cast<double>(map->getGlobalElement(i)));
  }
  problem.hessian().apply(x, fx);
  problem.hessian().apply(y, fy);
  EXPECT_GT(x.dot(fx), 0);
  EXPECT_NEAR(y.dot(fx), x.dot(fy), 1e-9 * std::abs(x.dot(fx)));
  auto forces = problem.jump().apply_transpose(x);
  double product = 0;
  std::vector<Eigen::VectorXd> u;
  for (auto& f : forces) {
    u.push_back(Eigen::VectorXd::LinSpaced(f.size(), -1, 2));
    product += f.dot(u.back());
  }
  product = cube.comm.sum(product);
  EXPECT_NE(product, 0);
  EXPECT_NEAR(product, problem.jump().apply(u).dot(x), 1e-9 * std::abs(product));
}

// Factors rounded to single precision: the solution is as near as they are, though loads alone do far more than those that
// balance; displacements balance exactly; and matrices see the exact problem.
TEST(DualProblem, RoundedFactorsChangeTheSolutionByAsMuch)
{
  const Cube exact(10, true);
  Cube cube(10, true);
  Subdomains rounded;
  for (std::size_t s = 0; s < cube.decomposition.subdomains.size(); ++s) {
    const auto& own = *cube.system.clusters.subdomains()[s];
    rounded.push_back(std::make_shared<ElasticSubdomain>(own.lower(), own.kernel(), cube.decomposition.subdomains[s].mesh.points,
                                                         3, "cholmod", 1e-5));
  }
  cube.system.clusters =
      Clusters(cube.decomposition, cube.interface, rounded, cube.system.nodal_stiffness, fem::Kinematics::solid);
  const auto problem = cube.problem(), in_double = cube.problem({}, Products::exact);
  const auto reference = exact.problem();
  EXPECT_EQ(reference.system().rounding(), 0);
  ASSERT_GT(problem.system().rounding(), 1e-9);
  ASSERT_LT(problem.system().rounding(), 1e-5);
  const auto solve = [](const DualProblem& p) {
    qp::Hessian hessian(p.hessian(), 1000);
    const qp::Programme programme{hessian, p.equality(), p.set()};
    const auto found = by_face_newton(p, programme, 1e-11);
    EXPECT_TRUE(found.converged);
    return found;
  };
  const auto energy = [&](const DualProblem& p, const std::vector<Eigen::VectorXd>& u) {
    double sum = 0;
    for (std::size_t s = 0; s < u.size(); ++s) sum += u[s].dot(p.system().clusters().subdomains()[s]->apply(u[s]));
    return cube.comm.sum(sum);
  };
  const auto found = solve(problem), expected = solve(reference);
  const auto u = problem.displacement(found.x, found.nu), v = reference.displacement(expected.x, expected.nu);
  auto difference = u;
  for (std::size_t s = 0; s < u.size(); ++s) difference[s] -= v[s];
  EXPECT_LT(std::sqrt(energy(reference, difference) / energy(reference, v)), 2 * problem.system().rounding());
  EXPECT_LT(problem.imbalance(u, found.x), 1e-12);

  const auto apart = [](const Vector& a, const Vector& b) { return (view(a) - view(b)).norm() / view(b).norm(); };
  Vector x(problem.jump().rows()), fx(x.getMap()), expected_fx(x.getMap());
  for (Local i = 0; i < static_cast<Local>(x.getLocalLength()); ++i)
    view(x)[i] = std::sin(static_cast<double>(x.getMap()->getGlobalElement(i)));
  reference.hessian().apply(x, expected_fx);
  problem.hessian().apply(x, fx);
  EXPECT_GT(cube.comm.max(apart(fx, expected_fx)), 1e-10);
  EXPECT_EQ(in_double.system().rounding(), 0);
  in_double.hessian().apply(x, fx);
  EXPECT_LT(cube.comm.max(apart(fx, expected_fx)), 1e-11);
  EXPECT_LT(cube.comm.max(apart(in_double.right_hand_side()->b, reference.right_hand_side()->b)), 1e-11);
}

// Every preconditioner is symmetric and positive, and saves products.
TEST(DualProblem, PreconditionersAreSymmetricAndApproximateTheInverse)
{
  const Cube cube(10, true);
  int without = std::numeric_limits<int>::max();
  for (const auto* kind : {"none", "lumped", "dirichlet"}) {
    Options options;
    options.preconditioner = kind;
    const auto problem = cube.problem(options);
    qp::Hessian hessian(problem.hessian(), 1000);
    const qp::Programme programme{hessian, problem.equality(), problem.set()};
    const auto solution = by_face_newton(problem, programme, 1e-9);
    EXPECT_TRUE(solution.converged);
    EXPECT_LT(hessian.count(), without) << kind;
    const auto preconditioner = problem.system().make_preconditioner();
    if (!preconditioner) {
      without = hessian.count();
      continue;
    }
    Vector x(problem.jump().rows()), y(x.getMap()), mx(x.getMap()), my(x.getMap());
    for (Local i = 0; i < static_cast<Local>(x.getLocalLength()); ++i) {
      const auto row = static_cast<double>(x.getMap()->getGlobalElement(i));
      view(x)[i] = std::sin(row);
      view(y)[i] = std::cos(3 * row);
    }
    preconditioner->apply(x, mx);
    preconditioner->apply(y, my);
    EXPECT_NEAR(x.dot(my), y.dot(mx), 1e-11 * mx.norm2() * y.norm2());
    EXPECT_GT(x.dot(mx), 0);
  }
}

// K and f of a cube that stands whole on this rank, its subdomains joined.
std::pair<Eigen::MatrixXd, Eigen::VectorXd> assembled(const Cube& whole)
{
  const auto nodes = static_cast<Eigen::Index>(whole.decomposition.catalogue.node_count);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * nodes);
  for (std::size_t s = 0; s < whole.decomposition.subdomains.size(); ++s) {
    const auto& id = whole.decomposition.subdomains[s].mesh.node_id;
    const auto unknown = [&](Eigen::Index i) { return 3 * id[static_cast<std::size_t>(i / 3)] + i % 3; };
    const auto& subdomain = *whole.system.clusters.subdomains()[s];
    const auto size = subdomain.size();
    for (Eigen::Index j = 0; j < size; ++j) {
      const Eigen::VectorXd column = subdomain.apply(Eigen::VectorXd::Unit(size, j));
      for (Eigen::Index i = 0; i < size; ++i) k(unknown(i), unknown(j)) += column[i];
      f[unknown(j)] += whole.load[s][j];
    }
  }
  return {k, f};
}

// Springs for supports, soft and stiff: as if their matrix had been added to that of the cube.
TEST(DualProblem, SpringsAreStiffnessOfTheWhole)
{
  for (const double stiffness : {1e-4, 1.0, 1e4})
    for (const char* kind : {"lumped", "dirichlet"}) {
      Cube cube(10, true);
      const Cube whole(10, true, MPI_COMM_SELF);
      auto [k, f] = assembled(whole);
      auto& springs = cube.constraints.springs;
      const auto& prescribed = whole.constraints.prescribed;
      std::vector<Eigen::Triplet<double>> entries;
      for (std::size_t i = 0; i < prescribed.size(); ++i) {
        springs.rows.push_back({{{prescribed[i].node, prescribed[i].component, 1.0}}});
        const auto is_here = [&](const auto& h) {
          return h.node == prescribed[i].node && h.component == prescribed[i].component;
        };
        if (std::any_of(cube.constraints.prescribed.begin(), cube.constraints.prescribed.end(), is_here))
          springs.own.push_back(i);
        entries.emplace_back(i, i, 4 * stiffness);
        if (i > 0) entries.emplace_back(i, i - 1, stiffness), entries.emplace_back(i - 1, i, stiffness);
      }
      springs.stiffness.resize(static_cast<int>(prescribed.size()), static_cast<int>(prescribed.size()));
      springs.stiffness.setFromTriplets(entries.begin(), entries.end());
      for (const auto& entry : entries) {
        const auto &a = prescribed[static_cast<std::size_t>(entry.row())], &b = prescribed[static_cast<std::size_t>(entry.col())];
        k(3 * a.node + a.component, 3 * b.node + b.component) += entry.value();
      }
      cube.constraints.prescribed.clear();
      Options options;
      options.preconditioner = kind;
      const auto problem = cube.problem(options);
      qp::Hessian hessian(problem.hessian(), 1000);
      const qp::Programme programme{hessian, problem.equality(), problem.set()};
      const auto solution = by_face_newton(problem, programme, 1e-8);
      ASSERT_TRUE(solution.converged) << solution.projected_gradient;
      EXPECT_LT(hessian.count(), 60) << stiffness;
      const auto u = problem.displacement(solution.x, solution.nu);
      const Eigen::VectorXd expected = dense::solve_symmetric(k, f);
      for (std::size_t s = 0; s < u.size(); ++s)
        for (std::size_t n = 0; n < cube.decomposition.subdomains[s].mesh.node_count(); ++n)
          EXPECT_LT((u[s].segment<3>(static_cast<Eigen::Index>(3 * n)) -
                     expected.segment<3>(3 * cube.decomposition.subdomains[s].mesh.node_id[n]))
                        .norm(),
                    1e-6 * expected.norm());
      // F x - d at once is what products and d make of it.
      const auto right = problem.right_hand_side();
      Vector parts(right->b.getMap()), at_once(right->b.getMap());
      problem.system().gradient(problem.hessian(), solution.x, *right, parts);
      problem.system().hessian().gradient(solution.x, *right, at_once);
      EXPECT_GT(parts.norm2(), 0);
      parts.update(-1, at_once, 1);
      EXPECT_LT(parts.norm2(), 1e-10 * right->b.norm2());
      // The energy of a residual is at least that of the error behind it.
      Vector x(problem.jump().rows()), r(x.getMap());
      for (Local i = 0; i < static_cast<Local>(x.getLocalLength()); ++i)
        view(x)[i] = std::sin(0.7 * static_cast<double>(x.getMap()->getGlobalElement(i)));
      problem.equality().project(x);
      const RememberedProduct product(problem.system().hessian());
      Displacements displacements(problem, product);
      const auto moved = problem.displacement(x, solution.nu), before = displacements.at_product(x, solution.nu);
      static_cast<const Operator&>(product).apply(x, r);
      const auto after = displacements.at_product(x, solution.nu);
      for (std::size_t s = 0; s < u.size(); ++s) {
        EXPECT_EQ(before[s], moved[s]);
        EXPECT_LT((after[s] - moved[s]).norm(), 1e-11 * moved[s].norm());
      }
      const double square = x.dot(r);
      problem.equality().project(r);
      EXPECT_GE(problem.system().make_preconditioner()->energy(r), (1 - 1e-9) * square);
    }
}

// Against the assembled system solved at once, for equal and for very different subdomains, with few products for both.
class Algorithms : public testing::TestWithParam<std::tuple<const char*, int>> {};
INSTANTIATE_TEST_SUITE_P(Both, Algorithms, testing::Combine(testing::Values("smalse", "face_newton"), testing::Values(1, 2, 8)));

TEST_P(Algorithms, SolutionIsThatOfTheAssembledSystem)
{
  const auto [algorithm, subdomains_per_cluster] = GetParam();
  for (const double jump : {1.0, 1e6}) {
    Cube cube(jump, true, MPI_COMM_WORLD, subdomains_per_cluster);
    const auto problem = cube.problem();
    EXPECT_EQ(problem.system().kernel_dimension(), 6 * 8 / subdomains_per_cluster);
    qp::Hessian hessian(problem.hessian(), 1000);
    const qp::Programme programme{hessian, problem.equality(), problem.set()};
    const qp::Solution solution = std::string(algorithm) == "smalse"
                                      ? qp::smalse({programme, *problem.right_hand_side(), problem.set()}, {}, 1e-10, {})
                                      : by_face_newton(problem, programme, 1e-9);
    ASSERT_TRUE(solution.converged) << solution.projected_gradient << " after " << hessian.count() << " products";
    EXPECT_LT(hessian.count(), subdomains_per_cluster == 1 ? 120 : 150);
    const auto u = problem.displacement(solution.x, solution.nu);

    const Cube whole(jump, true, MPI_COMM_SELF);  // every rank assembles it whole
    auto [k, f] = assembled(whole);
    for (const auto& h : whole.constraints.prescribed) {
      const auto i = 3 * h.node + h.component;
      f -= k.col(i) * h.value;
      k.row(i).setZero();
      k.col(i).setZero();
      k(i, i) = 1;
      f[i] = h.value;
    }
    for (const auto& h : whole.constraints.prescribed) f[3 * h.node + h.component] = h.value;
    const Eigen::VectorXd expected = dense::solve_symmetric(k, f);
    for (std::size_t s = 0; s < u.size(); ++s)
      for (std::size_t n = 0; n < cube.decomposition.subdomains[s].mesh.node_count(); ++n)
        EXPECT_LT((u[s].segment<3>(static_cast<Eigen::Index>(3 * n)) -
                   expected.segment<3>(3 * cube.decomposition.subdomains[s].mesh.node_id[n]))
                      .norm(),
                  1e-6 * expected.norm());
    EXPECT_LT(problem.imbalance(u, solution.x), 1e-9);
  }
}

// Residuals r = P F x are what an error x with G x = 0 leaves: (r'x)^2 / x'F x is at most their energy, and not far below it,
// where r'M r of the lumped preconditioner may be.
TEST(DualProblem, TheEnergyOfAResidualBoundsTheErrorBehindIt)
{
  for (const double jump : {1.0, 1e4})
    for (const char* kind : {"lumped", "dirichlet"}) {
      const Cube cube(jump, true);
      Options options;
      options.preconditioner = kind;
      const auto problem = cube.problem(options);
      const auto map = problem.hessian().getDomainMap();
      const auto preconditioner = problem.system().make_preconditioner();
      for (int wave = 1; wave < 30; wave += 4) {
        Vector x(map), r(map), z(map);
        for (Local i = 0; i < static_cast<Local>(map->getNodeNumElements()); ++i)
          view(x)[i] = std::sin(0.1 * wave * static_cast<double>(map->getGlobalElement(i)));
        problem.equality().project(x);
        problem.hessian().apply(x, r);
        const double square = x.dot(r);
        problem.equality().project(r);
        const double energy = preconditioner->energy(r);
        preconditioner->apply(r, z);
        EXPECT_GE(energy, (1 - 1e-9) * square);
        EXPECT_LE(energy, 20 * square);
        EXPECT_LE(energy, (1 + 1e-9) * z.dot(r) + 1e-2 * energy);
      }
    }
}

TEST(DualProblem, AFloatingBodyThatIsPulledIsNamed)
{
  const Cube cube(1, false);
  try {
    const auto problem = cube.problem();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
    EXPECT_NE(std::string(error.what()).find("body \"cube\" moves along"), std::string::npos) << error.what();
  }
}

TEST(DualProblem, AFloatingBodyThatNothingPullsIsGauged)
{
  Cube cube(1, false);
  for (auto& f : cube.load) f.setZero();
  const auto problem = cube.problem();
  EXPECT_EQ(cube.comm.sum(static_cast<long long>(problem.jump().ranges().end - problem.jump().ranges().extra)), 6);
}

TEST(RigidModes, AreFeltAsTheirDisplacementsAre)
{
  for (const int per_cluster : {1, 4}) {
    const Cube cube(100, true, MPI_COMM_SELF, per_cluster);
    const auto problem = cube.problem();
    const auto modes = rigid_modes(cube.decomposition, cube.system.clusters, fem::Kinematics::solid, cube.comm);
    ASSERT_EQ(modes.modes, 6);
    const auto& frame = modes.frames.front();
    const Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(6, -1, 2);
    const RigidMotion motion{0, frame.centre, a.head<3>(), frame.axes * a.tail<3>().cwiseQuotient(frame.arms)};
    std::vector<Eigen::VectorXd> u;
    for (const auto& subdomain : cube.decomposition.subdomains) {
      u.emplace_back(3 * static_cast<Eigen::Index>(subdomain.mesh.node_count()));
      for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
        u.back().segment<3>(3 * static_cast<Eigen::Index>(n)) = motion.at(subdomain.mesh.points[n]);
    }
    const Eigen::VectorXd felt = rows_of_bodies(problem.jump(), problem.equality().local(), modes) * a;
    const Eigen::VectorXd jumps = problem.jumps(u);
    EXPECT_GT(felt.norm(), 1);
    EXPECT_EQ(jumps.size(), problem.jump().ranges().dirichlet + felt.size());
    EXPECT_LT((jumps.tail(felt.size()) - felt).norm(), 1e-12 * felt.norm()) << per_cluster;
    EXPECT_LT(jumps.head(jumps.size() - felt.size()).norm(), 1e-12 * felt.norm()) << per_cluster;
  }
}

TEST(RigidMotion, IsDescribedInWords)
{
  EXPECT_EQ(describe({0, Point(1, 2, 3), Point(0, -2, 0), Point::Zero()}, 1), "moves along (0, -1, 0)");
  // A turn about the axis x = 2, y = 0: the centre at the origin moves along -y.
  EXPECT_EQ(describe({0, Point::Zero(), Point(0, -2, 0), Point(0, 0, 1)}, 1),
            "rotates about the axis through (2, 0, 0) along (0, 0, 1)");
}

}  // namespace
}  // namespace mortise::feti
