// Displacements that are made up: how far nodes are from where supports hold them, copies from each other, bodies in each other.
// The same on any ranks.
#include "post/compatibility.hpp"

#include "constraint/coupling.hpp"
#include "pieces.hpp"

namespace mortise::post {
namespace {

Eigen::VectorXd no_motion(const feti::DualProblem& problem)
{
  return Eigen::VectorXd::Zero(problem.equality().size());
}
Point at_rest(const Point&, int)
{
  return Point::Zero();
}

TEST(DistanceFromSupports, IsThatAlongWhatTheyPrescribe)
{
  Pieces block(false);
  block.guide(false);
  for (auto& dof : block.constraints.prescribed) dof.value = dof.support == 0 ? 0.25 : 0;
  const auto problem = block.problem();
  const auto distance = [&](const Point& shift) {
    return distance_from_supports(problem, block.displacement([&](const Point&, int) { return shift; }), no_motion(problem));
  };
  EXPECT_NEAR(distance({0, 0, 0.25}), 0, 1e-14);
  EXPECT_NEAR(distance({0, 0, 0.15}), 0.1, 1e-14);
  EXPECT_NEAR(distance({0.3, 0, 0.15}), 0.3, 1e-14);  // the guide of x
  EXPECT_NEAR(distance({0.3, -0.4, 0.25}), 0.4, 1e-14);

  // Along a direction that is no axis.
  block.constraints.prescribed.clear();
  const auto node = block.section("lower.zmin", 0)[0].first;
  if (block.comm.root()) block.constraints.skew_supports.push_back({node, {0.6, 0, 0.8}, 0.5, {}, 0});
  const auto skew = block.problem();
  const auto u = block.displacement([](const Point&, int) { return Point(0.3, 9, 0.1); });
  EXPECT_NEAR(distance_from_supports(skew, u, no_motion(skew)), 0.5 - 0.26, 1e-14);
}

// A spring lets go; the point of a rigid coupling takes its nodes along.
TEST(DistanceFromSupports, FollowsCouplingsAndLeavesSpringsOut)
{
  Pieces block(false);
  block.dirichlet_rows({{"lower.zmin", {0.0, 0.0, 0.0}}});
  auto& springs = block.constraints.springs;
  springs.rows.push_back({{{block.section("lower.zmax", 1)[0].first, 0, 1.0}}, 1, -1, {1, 0, 0}});
  springs.stiffness.resize(1, 1);
  springs.stiffness.insert(0, 0) = 1;
  auto& coupling = block.constraints.couplings.emplace_back();
  coupling.rigid = true;
  coupling.point = Point(1.5, 1.5, 1);
  coupling.motion = {0.0, 0.0, std::nullopt, std::nullopt, 0.0, 0.0};  // along z, about x
  const std::vector<mesh::Surface> top{block.side("lower.zmax")};
  const auto rows = constraint::coupled_rows(block.constraints.couplings, top, 1, 3, block.comm);
  auto& prescribed = block.constraints.prescribed;
  prescribed.insert(prescribed.end(), rows.begin(), rows.end());
  const auto problem = block.problem();
  Eigen::VectorXd nu = no_motion(problem);
  const auto motions = constraint::unknown_motions(problem.constraints(), 3);
  ASSERT_EQ(motions.size(), 2U);
  const auto first = problem.first_coupling_motion();
  nu[first] = 0.02 / motions[0].unit;
  nu[first + 1] = 0.01 / motions[1].unit;
  const auto follows = [](double up) {
    return [up](const Point& x, int) { return Point(0, 0, x[2] < 0.9 ? 0 : up + 0.01 * (x[1] - 1.5)); };
  };
  EXPECT_NEAR(distance_from_supports(problem, block.displacement(follows(0.02)), nu), 0, 1e-14);
  EXPECT_NEAR(distance_from_supports(problem, block.displacement(follows(0.05)), nu), 0.03, 1e-14);
  EXPECT_NEAR(distance_from_supports(problem, block.displacement(at_rest), nu), 0.03, 1e-14);  // 0.02 + 0.01 * 1
}

// A subdomain that leaves the other by t is t / 2 from the mean of the two; bodies across a bond are as far apart as they are.
TEST(DistanceBetweenParts, IsThatOfCopiesAndBonds)
{
  Pieces column;
  column.guide();
  column.join("upper.zmin", "lower.zmax", true);
  const auto problem = column.problem();
  const auto distance = [&](const auto& u) {
    return distance_between_parts(problem, column.decomposition, column.interface, u, no_motion(problem));
  };
  const auto away = [](const Point&, int) { return Point(0.03, 0.04, 0); };
  const auto slide = [](const Point&, int body) { return body == 0 ? Point(0, 0, 0) : Point(0.006, 0.008, -0.002); };
  EXPECT_NEAR(distance(column.displacement(at_rest)), 0, 1e-15);
  EXPECT_NEAR(distance(column.displacement(away)), 0, 1e-15);      // all of it
  EXPECT_NEAR(distance(column.displacement(slide)), 0.01, 1e-14);  // along the first tangent
  for (const auto& s : column.decomposition.subdomains)            // the last one touches no bond
    for (const auto& x : s.mesh.points) EXPECT_TRUE(s.id != 3 || x[2] > 1.4);
  EXPECT_NEAR(distance(column.displacement(away, 3)), 0.05 / 2, 1e-14);
}

TEST(Incompatibility, IsOverTheLargestDisplacement)
{
  Pieces column;
  column.guide();
  column.touch();
  for (const bool loaded : {false, true}) {
    if (loaded) column.add_traction("lower.zmax", Point(0, 0, -1));
    const auto problem = column.problem();
    const auto of = [&](const auto& u) {
      return incompatibility(problem, column.decomposition, column.interface, u, no_motion(problem));
    };
    EXPECT_EQ(of(column.displacement(at_rest)), 0);
    EXPECT_NEAR(of(column.displacement([](const Point&, int body) { return Point(0, 0, body == 1 ? -0.3 : 0); })), 1, 1e-12);
    EXPECT_NEAR(of(column.displacement([](const Point& x, int) { return Point(0, 0, 0.4 * x[2]); })), 0, 1e-12);
    EXPECT_NEAR(of(column.displacement([](const Point& x, int body) { return Point(0, 0, 0.4 * x[2] - 0.06 * body); })),
                0.06 / 0.74, 1e-12);
    EXPECT_NEAR(of(column.displacement([](const Point& x, int body) { return Point(0, 0, 0.4 * x[2] + 0.06 * body); })), 0,
                1e-12);  // an opening is none
    // The ground holds along z.
    EXPECT_NEAR(of(column.displacement([](const Point& x, int) { return Point(0, 0, 0.1 + 0.4 * x[2]); })), 0.1 / 0.9, 1e-12);
    // A tear in the lower block, beside displacements of the upper one that are ten times as large: the loaded body's own count.
    auto u = column.displacement([](const Point& x, int body) { return Point(0, 0, body == 0 ? 0.1 * x[2] : 1.0); });
    const auto tear = column.displacement([](const Point& x, int body) { return Point(0, 0, body == 0 ? 0.02 * x[2] : 0); }, 0);
    for (std::size_t s = 0; s < u.size(); ++s) u[s] += tear[s];
    EXPECT_NEAR(of(u), 0.01 / (loaded ? 0.12 : 1.0), 1e-12);
  }
}

}  // namespace
}  // namespace mortise::post
