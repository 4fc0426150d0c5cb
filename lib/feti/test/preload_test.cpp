// A column of two halves, 5 high, of section 1, tied node by node across a pretension section that is drawn together.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "constraint/pretension.hpp"
#include "feti/sparse_problem.hpp"
#include "qp/face_newton.hpp"
#include "qp/smalse.hpp"
#include "testing/blocks.hpp"

namespace mortise::feti {
namespace {

constexpr double young = 1000, force = 50, shortening = force * 5 / young;

struct Column : Blocks {
  // Held along z at its ends, or at the lower one alone; nothing keeps it from moving sideways, unless its foot is `clamped`.
  Column(const constraint::Preload& preload, bool both_ends, bool clamped = false)
      : Blocks({{"lower", {{0, 0, 0}, {1, 1, 2}, {2, 2, 4}, "hex8"}}, {"upper", {{0, 0, 2}, {1, 1, 3}, {2, 2, 6}, "hex8"}}},
               {{"lower", {1, 1, 2}}, {"upper", {1, 1, 3}}}, [](int) { return young; })
  {
    std::vector<constraint::Support> supports{{"lower.zmin", {std::nullopt, std::nullopt, 0.0}}};
    if (clamped) supports = {{"lower.zmin", {0.0, 0.0, 0.0}}};
    if (both_ends) supports.push_back({"upper.zmax", {std::nullopt, std::nullopt, 0.0}});
    dirichlet_rows(supports);
    join("upper.zmin", "lower.zmax", true);
    constraints.pretension_sections =
        constraint::find_pretension_sections(constraints.contacts, std::vector{preload}, 3, {}, comm);
  }
};

qp::Solution solve(const DualProblem& problem, const std::string& algorithm)
{
  qp::Hessian hessian(problem.hessian(), 1000);
  const auto right = problem.driven_right_hand_side(hessian);
  EXPECT_EQ(hessian.count(), right->driven ? 1 : 0);
  const qp::Programme programme{hessian, problem.equality(), problem.set()};
  if (algorithm == "smalse") return qp::smalse({programme, *right, problem.set()}, {}, 1e-10, {});
  const auto preconditioner = problem.system().make_preconditioner();
  return qp::FaceNewton(programme, preconditioner.get()).solve(*right, problem.set().radii(), nullptr, {}, {1e-10, {}}, {});
}

// Tension over the pretension section from the multipliers.
double tension(const DualProblem& problem, const Vector& lambda)
{
  double sum = 0;
  for (const auto& [row, part] : problem.constraints().pretension_sections[0].rows) {
    const auto at = problem.jump().ranges().contacts + static_cast<Local>(row);
    sum -= part * problem.forces(lambda)[at];
  }
  return problem.communicator().sum(sum);
}

class Preloads : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, Preloads, testing::Values("smalse", "face_newton"));

TEST_P(Preloads, AForceHasItsShortening)
{
  const Column column({0, "cut", force}, true);
  const auto problem = column.problem();
  EXPECT_EQ(problem.system().kernel_dimension(), 5 * 6);
  EXPECT_EQ(problem.equality().size(), 5 * 6 + 1);
  const auto solution = solve(problem, GetParam());
  ASSERT_TRUE(solution.converged);
  EXPECT_NEAR(tension(problem, solution.x), force, 1e-10 * force);
  const auto found = problem.shortenings(solution.nu);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0], shortening, 1e-8 * shortening);
  const auto u = problem.displacement(solution.x, solution.nu);
  EXPECT_LT(problem.imbalance(u, solution.x), 1e-10);
  // u_z rises to force / young * 2 below the pretension section, and from there as much less as it is drawn together.
  for (std::size_t s = 0; s < u.size(); ++s)
    for (std::size_t n = 0; n < column.decomposition.subdomains[s].mesh.node_count(); ++n) {
      const double z = column.decomposition.subdomains[s].mesh.points[n][2];
      const double expected = force / young * z - (column.decomposition.subdomains[s].body == 1 ? shortening : 0);
      EXPECT_NEAR(u[s][static_cast<Eigen::Index>(3 * n + 2)], expected, 1e-8 * shortening);
    }
}

TEST_P(Preloads, AShorteningHasItsForce)
{
  const Column column({0, "cut", {}, shortening}, true);
  const auto problem = column.problem();
  EXPECT_EQ(problem.equality().size(), 5 * 6);
  qp::Hessian hessian(problem.hessian(), 1);
  EXPECT_FALSE(problem.driven_right_hand_side(hessian)->driven);
  const auto solution = solve(problem, GetParam());
  ASSERT_TRUE(solution.converged);
  EXPECT_NEAR(tension(problem, solution.x), force, 1e-8 * force);
  EXPECT_EQ(problem.shortenings(solution.nu)[0], shortening);
}

// The shortening is a column more of sparse matrices; of another force it goes on from the solution before.
TEST(Preload, ByAForceHasTheSameSolutionWithSparseMatrices)
{
  const Column column({0, "cut", force}, true, true);
  const auto problem = column.problem();
  ASSERT_EQ(problem.equality().size(), problem.system().kernel_dimension() + 1);
  EXPECT_EQ(SparseProblem::turn(problem.system(), false), SparseProblem::Turn::second);  // so few rows
  const auto expected = solve(problem, "face_newton");
  ASSERT_TRUE(expected.converged);
  const SparseProblem sparse(problem.system());
  const auto right = problem.right_hand_side();
  const auto found = sparse.solve(*right, problem.set());
  ASSERT_TRUE(found.converged);
  const auto difference = [&](const Vector& x, double scale) {
    const Eigen::VectorXd lacks = problem.forces(x) - scale * problem.forces(expected.x);
    return std::sqrt(problem.communicator().sum(lacks.squaredNorm()));
  };
  EXPECT_LT(difference(found.x, 1), 1e-7 * force);
  EXPECT_NEAR(problem.shortenings(found.nu)[0], problem.shortenings(expected.nu)[0], 1e-8 * shortening);
  const auto twice = sparse.go_on(*right, right->b, 2 * right->e, problem.set(), found);
  ASSERT_TRUE(twice.converged);
  EXPECT_LT(difference(twice.x, 2), 1e-7 * force);
  EXPECT_NEAR(problem.shortenings(twice.nu)[0], 2 * problem.shortenings(expected.nu)[0], 1e-8 * shortening);
}

// The upper half follows the pull and nothing stops it: the bond does not, for it is what is drawn together.
TEST(Preload, AHalfThatNothingStopsIsNamed)
{
  const Column column({0, "cut", force}, false);
  try {
    const auto problem = column.problem();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
    EXPECT_NE(std::string(error.what()).find("body \"upper\" moves along (0, 0, -1)"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace mortise::feti
