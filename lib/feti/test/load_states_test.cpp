// Load states on one dual system: other loads and bounds of the same rows, on a cube cut into eight. The same on any ranks.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "cube.hpp"

namespace mortise::feti {
namespace {

// Other loads and another prescribed displacement: what with_loads() makes is what a problem of its own would be, to rounding.
TEST(LoadStates, OneOfOtherLoadsAndBoundsIsAsIfItWereAlone)
{
  Cube cube(10, true);
  const auto problem = cube.problem();
  const auto before = problem.right_hand_side();
  const Vector d(before->b, Teuchos::Copy);
  for (auto& f : cube.load) f *= -2.5;
  for (auto& prescribed : cube.constraints.prescribed) prescribed.value += 0.125 * prescribed.component;
  const auto next = problem.with_loads(cube.shared_constraints(), cube.load);
  ASSERT_TRUE(next);
  EXPECT_EQ(&next->system(), &problem.system());
  const auto fresh = cube.problem();
  const auto now = next->right_hand_side(), expected = fresh.right_hand_side();
  const auto apart = [](const Vector& a, const Vector& b) {
    Vector difference(a, Teuchos::Copy);
    difference.update(-1, b, 1);
    return difference.norm2();
  };
  EXPECT_LT(apart(now->b, expected->b), 1e-12 * expected->b.norm2());
  EXPECT_LT((now->e - expected->e).norm(), 1e-12 * before->e.norm());
  EXPECT_GT((now->e - before->e).norm(), 0.1 * before->e.norm());
  EXPECT_EQ(problem.right_hand_side(), before);
  EXPECT_EQ(apart(d, before->b), 0);
  EXPECT_GT(apart(now->b, before->b), 0.1 * before->b.norm2());
}

TEST(LoadStates, LoadsThatDriveAFreeMotionLaterAreNoEquilibrium)
{
  Cube cube(1, false);
  const auto pulled = cube.load;
  for (auto& f : cube.load) f.setZero();
  const auto problem = cube.problem();
  const auto next = problem.with_loads(cube.shared_constraints(), cube.load);
  ASSERT_TRUE(next);
  for (const auto* last : {&problem, &*next}) try {
      last->with_loads(cube.shared_constraints(), pulled);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
      EXPECT_NE(std::string(error.what()).find("driven by its loads"), std::string::npos);
    }
}

}  // namespace
}  // namespace mortise::feti
