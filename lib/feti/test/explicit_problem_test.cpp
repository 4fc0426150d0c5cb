// A block that floats on another: the dual operator as a matrix against products with it, and the direct solution against face
// Newton's.
#include "feti/explicit_problem.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "constraint/pretension.hpp"
#include "constraint/supports.hpp"
#include "fem/loads.hpp"
#include "fem/stiffness.hpp"
#include "feti/row_distribution.hpp"
#include "feti/sparse_problem.hpp"
#include "qp/face_newton.hpp"
#include "testing/stack.hpp"

namespace mortise::feti {
namespace {

constexpr double coefficient = 0.4;

// What a stack has beside the supports below.
struct Variant {
  bool upper_prescribed = false;          // along x on top, where there is a preload along all axes
  bool skew_supports = false;             // at nodes of the lower block that are prescribed along another axis, too
  bool rotated = false;                   // the operator of the upper block is that of a rotated copy
  double moved = 0;                       // along x, by all supports
  std::optional<double> force = {};       // of a preload: the blocks are bonded and drawn together,
  std::optional<double> shortening = {};  // or by so much

  bool preloaded() const { return force || shortening; }
};

// Prescribed at z = 0; pressed down and pushed sideways on top, where the upper block stands on the nodes of the lower one.
struct PressedStack : Stack {
  PressedStack(const Point& traction, int pieces, const Variant& variant = {})
      : Stack({2, 4, pieces}, 1000, MPI_COMM_WORLD, [&](const partition::Subdomain& s) {
          return variant.rotated && s.body == 1 ? std::optional(rotate()) : std::nullopt;
        })
  {
    add_traction("upper.zmax", traction);
    std::vector<constraint::Support> supports{{"lower.zmin", {variant.moved, 0, 0}}};
    if (variant.upper_prescribed) {
      const std::optional<double> others = variant.preloaded() ? std::optional(0.0) : std::nullopt;
      supports.push_back({"upper.zmax", {variant.moved, others, others}});
    }
    dirichlet_rows(supports);
    if (variant.skew_supports) skew_support_rows();
    join("upper.zmin", "lower.zmax", variant.preloaded());
    if (variant.preloaded())
      constraints.pretension_sections = constraint::find_pretension_sections(
          constraints.contacts, std::vector{constraint::Preload{0, "cut", variant.force, variant.shortening.value_or(0)}}, 3, {},
          comm);
    constraints.prescribed = distribute_rows(constraints.prescribed, decomposition, *directory, comm);
    constraints.skew_supports = distribute_rows(constraints.skew_supports, decomposition, *directory, comm);
  }

  static Eigen::Matrix3d rotate() { return Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()).toRotationMatrix(); }

  // The lower block's nodes at x = z = 0 are prescribed along y, and along a direction between x and z instead of these.
  void skew_support_rows()
  {
    std::vector<Global> edge;
    for (const auto& node : nodes_of("lower.zmin"))
      if (node.x < 0.1) edge.push_back(node.id);
    std::vector<constraint::PrescribedDof> left;
    for (const auto& prescribed : constraints.prescribed) {
      if (prescribed.component == 1 || std::find(edge.begin(), edge.end(), prescribed.node) == edge.end())
        left.push_back(prescribed);
      else if (prescribed.component == 0)
        constraints.skew_supports.push_back({prescribed.node, {0.6, 0, 0.8}, 0.01, {}, 0});
    }
    constraints.prescribed = std::move(left);
  }
};

// The whole of it on every rank, by products with the unit vectors, nothing eliminated.
struct Dense {
  Eigen::MatrixXd f, g;
  Eigen::VectorXd d;
  qp::FeasibleSet set;
  const Communicator& comm;
  const Map& rows;

  explicit Dense(const DualProblem& problem) : comm(problem.communicator()), rows(*problem.jump().rows())
  {
    const auto size = static_cast<Eigen::Index>(problem.system().dual_unknowns());
    f.resize(size, size);
    const auto& part = problem.equality().local();
    g = Eigen::MatrixXd::Zero(part.rows(), size);
    for (Local i = 0; i < part.cols(); ++i) g.col(number(i)) = part.col(i);
    comm.sum_in_place({g.data(), static_cast<std::size_t>(g.size())});
    d = whole(problem.right_hand_side()->b);
    for (Eigen::Index j = 0; j < size; ++j) {
      Vector unit(problem.jump().rows()), product(problem.jump().rows());
      if (const Local i = rows.getLocalElement(j); i != Teuchos::OrdinalTraits<Local>::invalid()) view(unit)[i] = 1;
      problem.hessian().apply(unit, product);
      f.col(j) = whole(product);
    }
    struct Unknowns {
      Local normal, first, second;
    };
    std::vector<Unknowns> points;
    for (const auto& bound : problem.set().bounds()) points.push_back({number(bound.index), -1, -1});
    for (std::size_t i = 0; i < problem.set().discs().size(); ++i) {
      const auto& disc = problem.set().discs()[i];
      points[i] = {number(disc.normal), number(disc.index[0]), number(disc.index[1])};
    }
    std::vector<qp::Bound> bounds;
    std::vector<qp::Disc> discs;
    for (const auto& point : comm.all_gather(points)) {
      bounds.push_back({point.normal, 0});
      discs.push_back({{point.first, point.second}, std::numeric_limits<double>::infinity()});
      discs.back().normal = point.normal;
      discs.back().coefficient = coefficient;
    }
    set = qp::FeasibleSet(std::move(bounds), std::move(discs));
  }

  Local number(Local i) const { return static_cast<Local>(rows.getGlobalElement(i)); }
  Eigen::VectorXd whole(const Vector& x) const
  {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.getGlobalNumElements()));
    const auto own = view(x);
    for (Local i = 0; i < own.size(); ++i) all[number(i)] = own[i];
    comm.sum_in_place({all.data(), static_cast<std::size_t>(all.size())});
    return all;
  }
};

class Varied : public testing::TestWithParam<std::tuple<int, Variant>> {};
INSTANTIATE_TEST_SUITE_P(Piecewise, Varied,
                         testing::Combine(testing::Values(1, 2),
                                          testing::Values(Variant{}, Variant{true}, Variant{false, true, false, 0.02},
                                                          Variant{true, true, false, 0.02}, Variant{true, false, true, 0.02},
                                                          Variant{false, true, true}, Variant{true, false, false, 0.01, 3.0},
                                                          Variant{true, false, false, 0.01, {}, 0.02})));

TEST_P(Varied, HasTheInverseOfTheDualOperator)
{
  const auto& [pieces, variant] = GetParam();
  const PressedStack stack(Point(1, 0.5, -10), pieces, variant);
  const auto problem = stack.problem();
  ExplicitProblem direct(problem.system(), 0);
  const auto map = problem.hessian().getDomainMap();
  for (Global row = 0; row < problem.system().dual_unknowns(); row += 7) {  // F^-1 F e_i = e_i
    Vector unit(map), product(map), back(map);
    if (const Local i = map->getLocalElement(row); i != Teuchos::OrdinalTraits<Local>::invalid()) view(unit)[i] = 1;
    problem.hessian().apply(unit, product);
    direct.apply(product, back, Teuchos::NO_TRANS, 1, 0);
    back.update(-1, unit, 1);
    EXPECT_LT(back.normInf(), 1e-8) << row;
    back.assign(unit);
    direct.apply(product, back, Teuchos::NO_TRANS, 2, 3);  // 2 F^-1 F e_i + 3 e_i
    back.update(-5, unit, 1);
    EXPECT_LT(back.normInf(), 1e-7) << row;
  }
}

TEST_P(Varied, SolvesAsWithoutElimination)
{
  const auto& [pieces, variant] = GetParam();
  const PressedStack stack(Point(1, 0.5, -10), pieces, variant);
  const auto problem = stack.problem();
  auto set = problem.set();
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  set.set_radii(std::vector<double>(set.discs().size(), std::numeric_limits<double>::infinity()));
  const auto right = problem.right_hand_side();
  const auto found = ExplicitProblem(problem.system(), 0).solve(right->b, right->e, set);
  ASSERT_TRUE(found.converged);

  const Dense dense(problem);
  const auto motions = dense.g.rows();
  const auto expected = qp::CondensedNewton(dense.f, dense.g, Eigen::MatrixXd::Zero(motions, motions), dense.set)
                            .solve(dense.d, right->e, dense.set);
  ASSERT_TRUE(expected.converged);
  EXPECT_GT(expected.x.norm(), 0.1);
  EXPECT_LT((dense.whole(found.x) - expected.x).norm(), 1e-9 * expected.x.norm());
  EXPECT_LT((found.nu - expected.nu).norm(), 1e-9 * expected.nu.norm());
}

// Where G has rigid motions alone: with sparse matrices it is the same solution and the same inverse.
TEST_P(Varied, SolvesAsWithSparseMatrices)
{
  const auto& [pieces, variant] = GetParam();
  const PressedStack stack(Point(1, 0.5, -10), pieces, variant);
  if (variant.force) GTEST_SKIP() << "not for unknowns of their own";
  const auto problem = stack.problem();
  EXPECT_EQ(SparseProblem::turn(problem.system(), false), SparseProblem::Turn::second);  // so few rows
  auto set = problem.set();
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  set.set_radii(std::vector<double>(set.discs().size(), std::numeric_limits<double>::infinity()));
  const SparseProblem sparse(problem.system());
  const auto right = problem.right_hand_side();
  const auto found = sparse.solve(*right, set);
  ASSERT_TRUE(found.converged);
  const ExplicitProblem direct(problem.system());
  const auto expected = direct.solve(right->b, right->e, set);
  ASSERT_TRUE(expected.converged);
  const auto expect_near = [](const Vector& a, const Vector& b) {
    Vector difference(a, Teuchos::Copy);
    difference.update(-1, b, 1);
    EXPECT_LT(difference.norm2(), 1e-8 * b.norm2());
  };
  expect_near(found.x, expected.x);
  EXPECT_LT((found.nu - expected.nu).norm(), 1e-8 * expected.nu.norm());

  Vector in(found.x.getMap()), out(in.getMap()), other(in.getMap());
  in.randomize();
  direct.apply(in, out, Teuchos::NO_TRANS, 1, 0);
  sparse.apply(in, other, Teuchos::NO_TRANS, 1, 0);
  expect_near(other, out);

  Vector linear(right->b, Teuchos::Copy);
  linear.update(1e-3, in, 1);
  const Eigen::VectorXd e = right->e.array() + 1e-3;
  const auto changed = direct.solve(linear, e, set);
  const auto next = sparse.go_on(*right, linear, e, set, found);
  EXPECT_TRUE(next.converged);
  expect_near(next.x, changed.x);
  // Matrices that have solved nothing go on from what others found, and know its states.
  const auto other_next = SparseProblem(problem.system()).go_on(*right, linear, e, set, expected);
  EXPECT_TRUE(other_next.converged);
  expect_near(other_next.x, changed.x);

  // Gaps and nu are a gradient.
  const Eigen::VectorXd gaps = problem.gaps(in, found.nu);
  expect_near(problem.gradient(gaps, found.nu), in);
}

class Directly : public testing::TestWithParam<std::pair<double, int>> {};
INSTANTIATE_TEST_SUITE_P(PushesAndPieces, Directly,
                         testing::Values(std::pair{0.0, 1}, std::pair{1.0, 1}, std::pair{2.0, 1}, std::pair{2.0, 3}));

// Pressed with 10, a push of up to 4 is prescribed.
TEST_P(Directly, SolvesAsFaceNewtonDoes)
{
  const auto [push, pieces] = GetParam();
  const PressedStack stack(Point(push, 0, -10), pieces);
  const auto problem = stack.problem();
  auto set = problem.set();
  ASSERT_EQ(stack.comm.sum(static_cast<long long>(set.discs().size())), 16);
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  set.set_radii(std::vector<double>(set.discs().size(), std::numeric_limits<double>::infinity()));
  const ExplicitProblem direct(problem.system());
  const auto right = problem.right_hand_side();
  const auto found = direct.solve(right->b, right->e, set);
  ASSERT_TRUE(found.converged);

  // Coulomb's law: within cones; and with the radii that it gives it is the one solution of a problem with fixed radii.
  std::vector<double> radii;
  for (const auto& disc : set.discs()) radii.push_back(coefficient * view(found.x)[disc.normal]);
  set.set_radii(radii);
  qp::Hessian hessian(problem.hessian(), 2000);
  const qp::Programme programme{hessian, problem.equality(), set};
  const auto lumped = problem.system().make_preconditioner();
  const auto expected = qp::FaceNewton(programme, lumped.get()).solve(*right, radii, nullptr, {}, {1e-10, {}}, {});
  ASSERT_TRUE(expected.converged);
  Vector difference(found.x, Teuchos::Copy);
  difference.update(-1, expected.x, 1);
  EXPECT_LT(difference.norm2(), 1e-6 * expected.x.norm2());
  EXPECT_LT((found.nu - expected.nu).norm(), 1e-6 * expected.nu.norm());
  const auto u = problem.displacement(found.x, found.nu);
  EXPECT_LT(problem.imbalance(u, found.x), 1e-8);

  // As a start it is the end.
  qp::Hessian again(problem.hessian(), 2000);
  const qp::Programme repeated{again, problem.equality(), set};
  ExplicitProblem preconditioner(problem.system());
  const auto shown = qp::FaceNewton(repeated, &preconditioner)
                         .solve(*right, radii, nullptr, qp::Solution(found.x, found.x, found.nu), {1e-8, {}}, {});
  EXPECT_TRUE(shown.converged);
  EXPECT_LT(again.count(), 12);
}

// Bodies whose supports are eliminated are factorized by the solver of the deck.
TEST(ExplicitProblem, TakesTheFactorizationThatIsAskedFor)
{
  const PressedStack stack(Point(1, 0.5, -10), 2);
  const auto solve = [&](const std::string& factorization) {
    const auto problem = stack.problem({.factorization = factorization, .preconditioner = "none"});
    auto set = problem.set();
    set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
    const auto right = problem.right_hand_side();
    return Eigen::VectorXd(view(ExplicitProblem(problem.system(), 0).solve(right->b, right->e, set).x));
  };
  const Eigen::VectorXd x = solve("cholmod");
  EXPECT_GT(stack.comm.sum(x.squaredNorm()), 0.01);
  for (const char* other : {"cholmod_plain", "klu2"})
    EXPECT_LT(stack.comm.sum((solve(other) - x).squaredNorm()), 1e-18 * stack.comm.sum(x.squaredNorm())) << other;
  EXPECT_THROW(solve("none_of_these"), Error);
}

TEST(ExplicitProblem, SaysWhereNothingBalancesTheLoads)
{
  const PressedStack stack(Point(4.5, 0, -10), 1);  // friction holds 4
  const auto problem = stack.problem();
  auto set = problem.set();
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  const auto right = problem.right_hand_side();
  EXPECT_FALSE(ExplicitProblem(problem.system()).solve(right->b, right->e, set).converged);
}

}  // namespace
}  // namespace mortise::feti
