// A block that floats on another: the dual operator as a matrix against products with it, and the direct solution against face
// Newton's.
#include "feti/explicit_problem.hpp"

#include <gtest/gtest.h>

#include "blocks.hpp"
#include "qp/face_newton.hpp"

namespace mortise::feti {
namespace {

constexpr double coefficient = 0.4;

// Held at z = 0; pressed down and pushed sideways on top, where the upper block stands on the nodes of the lower one.
struct Stack : Blocks {
  Stack(const Point& traction, int pieces)
      : Blocks({{"lower", {{0, 0, 0}, {1, 1, 1}, {3, 3, 2}, "hex8"}}, {"upper", {{0, 0, 1}, {1, 1, 2}, {3, 3, 4}, "hex8"}}},
               {{"lower", {1, 1, 1}}, {"upper", {1, 1, pieces}}}, [](int) { return 1000.0; })
  {
    pull("upper.zmax", traction);
    hold({{"lower.zmin", {0, 0, 0}}});
    join("upper.zmin", "lower.zmax", false);
  }
};

TEST(ExplicitProblem, IsTheInverseOfTheDualOperator)
{
  const Stack stack(Point(1, 0.5, -10), 2);
  DualProblem problem(stack.decomposition, *stack.directory, stack.interface, stack.constraints, stack.floating, {},
                      stack.context);
  ExplicitProblem direct(problem);
  const auto map = problem.hessian().getDomainMap();
  for (Global row = 0; row < problem.dual_unknowns(); row += 7) {  // F^-1 F e_i = e_i
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

class Directly : public testing::TestWithParam<std::pair<double, int>> {};
INSTANTIATE_TEST_SUITE_P(PushesAndPieces, Directly,
                         testing::Values(std::pair{0.0, 1}, std::pair{1.0, 1}, std::pair{2.0, 1}, std::pair{2.0, 3}));

// Pressed with 10, a push of up to 4 is held.
TEST_P(Directly, SolvesAsFaceNewtonDoes)
{
  const auto [push, pieces] = GetParam();
  const Stack stack(Point(push, 0, -10), pieces);
  DualProblem problem(stack.decomposition, *stack.directory, stack.interface, stack.constraints, stack.floating, {},
                      stack.context);
  auto& set = problem.set();
  ASSERT_EQ(stack.comm.sum(static_cast<long long>(set.discs().size())), 16);
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  set.set_radii(std::vector<double>(set.discs().size(), std::numeric_limits<double>::infinity()));
  const ExplicitProblem direct(problem);
  const auto found = direct.solve();
  ASSERT_TRUE(found.settled);

  // Coulomb's law: within cones; and with the radii that it gives it is the one solution of a problem with fixed radii.
  std::vector<double> radii;
  for (const auto& disc : set.discs()) radii.push_back(coefficient * view(found.x)[disc.normal]);
  set.set_radii(radii);
  qp::Hessian hessian(problem.hessian(), 2000);
  const qp::Problem programme{hessian, problem.linear(), problem.equality(), set};
  const auto expected = qp::FaceNewton(programme, problem.preconditioner()).solve({}, {1e-10, {}}, nullptr, {});
  ASSERT_TRUE(expected.converged);
  Vector difference(found.x, Teuchos::Copy);
  difference.update(-1, expected.x, 1);
  EXPECT_LT(difference.norm2(), 1e-6 * expected.x.norm2());
  EXPECT_LT((found.nu - expected.nu).norm(), 1e-6 * expected.nu.norm());
  const auto u = problem.displacement(found.x, found.nu);
  EXPECT_LT(problem.imbalance(u, found.x), 1e-8);

  // As a start it is the end.
  qp::Hessian again(problem.hessian(), 2000);
  const qp::Problem repeated{again, problem.linear(), problem.equality(), set};
  ExplicitProblem preconditioner(problem);
  const auto shown =
      qp::FaceNewton(repeated, &preconditioner).solve(qp::Solution(found.x, found.x, found.nu), {1e-8, {}}, nullptr, {});
  EXPECT_TRUE(shown.converged);
  EXPECT_LT(again.count(), 12);
}

TEST(ExplicitProblem, SaysWhereNothingBalancesTheLoads)
{
  const Stack stack(Point(4.5, 0, -10), 1);  // friction holds 4
  DualProblem problem(stack.decomposition, *stack.directory, stack.interface, stack.constraints, stack.floating, {},
                      stack.context);
  auto& set = problem.set();
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  EXPECT_FALSE(ExplicitProblem(problem).solve().settled);
}

}  // namespace
}  // namespace mortise::feti
