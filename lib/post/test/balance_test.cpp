// Forces of supports, couplings and springs against statics: what they do balances what is known to act. The same on any ranks.
#include "post/balance.hpp"

#include "constraint/coupling.hpp"
#include "pieces.hpp"

namespace mortise::post {
namespace {

constexpr double pressed = 3, force = pressed * Pieces::area;  // the pressure on top, and what it comes to

// The ground bears all of the pressure, with the moment of a force at the middle of the section; guides bear nothing.
TEST(Reactions, OfAPressedColumn)
{
  Pieces column;
  column.guide();
  column.touch();
  column.add_traction("upper.zmax", Point(0, 0, -pressed));
  const auto problem = column.problem();
  const auto lambda = solved(problem).solution.x;
  const auto found = reactions(problem, lambda, 5);
  ASSERT_EQ(found.size(), 5U);
  expect_near(found[0].force, {0, 0, force});
  expect_near(found[0].moment, {1.5 * force, -1.5 * force, 0});
  for (std::size_t s = 1; s < 5; ++s) {
    expect_near(found[s].force, Point::Zero());
    expect_near(found[s].moment, Point::Zero());
  }

  // Each node of the ground bears its share of the area, at every copy; nodes elsewhere nothing.
  const auto holding = holding_forces(problem, column.decomposition, column.interface, lambda);
  ASSERT_EQ(holding.size(), column.decomposition.subdomains.size());
  for (std::size_t s = 0; s < holding.size(); ++s)
    for (Eigen::Index n = 0; n < holding[s].rows(); ++n) {
      const Point& x = column.decomposition.subdomains[s].mesh.points[static_cast<std::size_t>(n)];
      const Point exact = x[2] == 0 ? Point(0, 0, pressed * Pieces::share(x)) : Point::Zero();
      EXPECT_LT((Point(holding[s].row(n).transpose()) - exact).norm(), 1e-8) << x.transpose();
    }
}

// Springs under each node of the ground, as stiff as its share of the area: the column sinks as a whole.
TEST(Reactions, OfAnElasticFoundation)
{
  constexpr double foundation = 50;  // a pressure over a length
  Pieces column(false);
  column.guide(false);
  std::erase_if(column.constraints.prescribed, [](const auto& dof) { return dof.support == 0; });
  auto& springs = column.constraints.springs;
  const auto ground = column.section("lower.zmin", 0);
  springs.stiffness.resize(static_cast<int>(ground.size()), static_cast<int>(ground.size()));
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const auto& [node, x] = ground[i];
    springs.rows.push_back({{{node, 2, 1.0}}, 0, -1, {0, 0, 1}, {x[0], x[1], x[2]}});
    springs.stiffness.insert(static_cast<int>(i), static_cast<int>(i)) = foundation * Pieces::share(x);
  }
  column.add_traction("lower.zmax", Point(0, 0, -pressed));
  const auto problem = column.problem();
  const auto result = solved(problem);
  const auto found = reactions(problem, result.solution.x, 3);
  expect_near(found[0].force, {0, 0, force});
  expect_near(found[0].moment, {1.5 * force, -1.5 * force, 0});
  expect_near(found[1].force, Point::Zero());
  const auto u = problem.displacement(result.solution.x, result.solution.nu);
  const auto holding = holding_forces(problem, column.decomposition, column.interface, result.solution.x);
  for (std::size_t s = 0; s < holding.size(); ++s)
    for (Eigen::Index n = 0; n < holding[s].rows(); ++n) {
      const Point& x = column.decomposition.subdomains[s].mesh.points[static_cast<std::size_t>(n)];
      if (x[2] != 0) continue;
      EXPECT_NEAR(u[s][3 * n + 2], -pressed / foundation, 1e-9);
      EXPECT_NEAR(holding[s](n, 2), pressed * Pieces::share(x), 1e-8);
    }
}

// A block in any uniform stress, held at z = 0 along three directions none of which is an axis; two supports share the second.
TEST(Reactions, OfTiltedSupports)
{
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.6, Point(1, -2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d strain = (Eigen::Matrix3d() << 3, 1, -2, 1, -4, 0.5, -2, 0.5, 5).finished() * 1e-3;
  const double shear = Pieces::young / (1 + Pieces::poisson), lame = shear * Pieces::poisson / (1 - 2 * Pieces::poisson);
  const Eigen::Matrix3d stress = shear * strain + lame * strain.trace() * Eigen::Matrix3d::Identity();
  const Point split(0.3, -0.1, 0.2);  // of the second direction, what its first support bears

  Pieces block(false);
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, static_cast<char>('x' + c));
    block.add_traction("lower." + axis + "max", stress.col(c));
    if (c < 2) block.add_traction("lower." + axis + "min", -stress.col(c));
  }
  const auto ground = block.section("lower.zmin", 0);
  for (std::size_t i = 0; i < ground.size(); ++i) {
    if (!block.mine(i)) continue;
    const auto& [node, x] = ground[i];
    for (int k = 0; k < 3; ++k) {
      const Point n = axes.col(k);
      constraint::SkewSupport row{node, {n[0], n[1], n[2]}, n.dot(strain * x), {}, 0, {x[0], x[1], x[2]}};
      if (k == 1) {
        row.add_share(1, split);
        row.add_share(3, n - split);
      } else {
        row.add_share(k, n);
      }
      block.constraints.skew_supports.push_back(row);
    }
  }
  const auto problem = block.problem();
  const auto result = solved(problem);
  const auto u = problem.displacement(result.solution.x, result.solution.nu);
  const auto exact = block.displacement([&](const Point& x, int) { return Point(strain * x); });
  for (std::size_t s = 0; s < u.size(); ++s) EXPECT_LT((u[s] - exact[s]).norm(), 1e-9);

  const Point traction = -stress.col(2);  // that of the ground
  const auto found = reactions(problem, result.solution.x, 4);
  const std::vector<Point> parts{axes.col(0), split, axes.col(2), axes.col(1) - split};
  const std::vector<int> along{0, 1, 2, 1};
  for (std::size_t s = 0; s < 4; ++s) {
    const Point own = Pieces::area * traction.dot(axes.col(along[s])) * parts[s];
    EXPECT_GT(own.norm(), 0.1);
    expect_near(found[s].force, own);
    expect_near(found[s].moment, Pieces::centre.cross(own));
  }
  const auto holding = holding_forces(problem, block.decomposition, block.interface, result.solution.x);
  for (std::size_t s = 0; s < holding.size(); ++s)
    for (Eigen::Index n = 0; n < holding[s].rows(); ++n) {
      const Point& x = block.decomposition.subdomains[s].mesh.points[static_cast<std::size_t>(n)];
      const Point own = x[2] == 0 ? Point(Pieces::share(x) * traction) : Point::Zero();
      EXPECT_LT((Point(holding[s].row(n).transpose()) - own).norm(), 1e-8) << x.transpose();
    }
}

// What a contact pushes on a node with along what a support holds there goes straight into the support.
TEST(Reactions, TakeContactForcesOfHeldNodes)
{
  Pieces column;
  column.guide();
  column.join("upper.zmin", "lower.zmax", true);
  const Point at(1.2, 0.7, 1);
  if (column.comm.root()) column.constraints.contacts.prescribed.push_back({0, 1, 3, 0.25, {at[0], at[1], at[2]}});
  const auto problem = column.problem();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(problem.jump().ranges().end);
  if (column.comm.root()) forces[problem.jump().ranges().contacts] = 8;
  const auto found = reactions(problem, problem.multipliers(forces), 5);
  expect_near(found[3].force, {0, 2, 0});
  expect_near(found[3].moment, at.cross(Point(0, 2, 0)));
  expect_near(found[0].force, Point::Zero());
}

// Force and moment of what holds a block at z = 0, about a point.
std::pair<Point, Point> of_ground(const Reaction& reaction, const Point& about)
{
  const Point sum = vector(reaction.force);
  return {sum, vector(reaction.moment) - about.cross(sum)};
}

// A rigid coupling of the top, beside its middle: free to follow its load, or held along z and in its angles.
TEST(Couplings, RigidOnesHandOnWhatActsOnThem)
{
  const Point point(1.7, 1.2, 1.5);
  for (const bool held : {false, true}) {
    Pieces block(false);
    block.dirichlet_rows({{"lower.zmin", {0.0, 0.0, 0.0}}});
    auto& coupling = block.constraints.couplings.emplace_back();
    coupling.rigid = true;
    coupling.point = point;
    coupling.load = {0.2, -0.3, -6, 0.4, 0.1, -0.5};
    if (held) coupling.motion = {std::nullopt, std::nullopt, -0.01, 0.0, 0.002, 0.0};
    const std::vector<mesh::Surface> top{block.side("lower.zmax")};
    const auto rows = constraint::coupled_rows(block.constraints.couplings, top, 1, 3, block.comm);
    auto& prescribed = block.constraints.prescribed;
    prescribed.insert(prescribed.end(), rows.begin(), rows.end());
    const auto problem = block.problem();
    const auto result = solved(problem);
    const auto& lambda = result.solution.x;
    const auto states = coupling_states(problem, lambda);
    ASSERT_EQ(states.size(), 1U);
    const auto& [motion, action, reaction] = states[0];
    const auto [push, turn] = of_ground(reactions(problem, lambda, 1)[0], point);
    for (std::size_t k = 0; k < 6; ++k) {
      const bool free = !coupling.motion[k];
      EXPECT_NEAR(action[k], -(k < 3 ? push[static_cast<int>(k)] : turn[static_cast<int>(k) - 3]), 1e-8) << k;
      EXPECT_NEAR(reaction[k], action[k] - coupling.load[k], 1e-12) << k;
      EXPECT_EQ(std::abs(reaction[k]) < 1e-8, free) << k << ": " << reaction[k];
    }
  }
}

// The mean motion of the top along z and about x is given, by area; part of the load at the point is spread over the top.
TEST(Couplings, DistributingOnesAreHeldInTheMean)
{
  constexpr double arm = 0.7, spread = -0.5;
  const Point point(1.5, 1.5, 1);
  Pieces block(false);
  block.dirichlet_rows({{"lower.zmin", {0.0, 0.0, 0.0}}});
  block.add_traction("lower.zmax", Point(0, 0, spread / Pieces::area));
  auto& coupling = block.constraints.couplings.emplace_back();
  coupling.point = point;
  coupling.arm = arm;
  coupling.load = {0, 0, spread, 0, 0, 0};
  const auto top = block.section("lower.zmax", 1);
  double second = 0;
  for (const auto& [node, x] : top) second += Pieces::share(x) * std::pow(x[1] - point[1], 2);
  constraint::MeanMotion along{0, 2, -0.01, {}}, about{0, 3, arm * 0.004, {}};
  for (const auto& [node, x] : top) {
    along.entries.push_back({node, 2, Pieces::share(x) / Pieces::area});
    about.entries.push_back({node, 2, arm * Pieces::share(x) * (x[1] - point[1]) / second});
  }
  if (block.comm.root()) block.constraints.mean_motions = {along, about};
  const auto problem = block.problem();
  const auto lambda = solved(problem).solution.x;
  const auto states = coupling_states(problem, lambda);
  ASSERT_EQ(states.size(), 1U);
  const auto& [motion, action, reaction] = states[0];
  const auto [push, turn] = of_ground(reactions(problem, lambda, 1)[0], point);
  EXPECT_NEAR(action[2], -push[2], 1e-8);
  EXPECT_NEAR(action[3], -turn[0], 1e-8);
  EXPECT_LT(action[2], -1);
  EXPECT_GT(action[3], 0.1);
  for (const std::size_t k : {0U, 1U, 4U, 5U}) EXPECT_EQ(action[k], 0) << k;
  EXPECT_NEAR(reaction[2], action[2] - spread, 1e-12);
}

// The upper block hangs on two springs to the lower one and on a support's: together they bear the pull.
TEST(Springs, PullWithWhatHangsOnThem)
{
  constexpr double soft = 40, support = 20, stiff = 120, pull = 2;
  Pieces column;
  column.guide();
  const auto below = column.section("lower.zmax", 1), above = column.section("upper.zmin", 1);
  auto& springs = column.constraints.springs;
  const auto between = [&](std::size_t i, int number) {
    return constraint::SpringRow{{{above[i].first, 2, 1.0}, {below[i].first, 2, -1.0}}, -1, number, {0, 0, 1}};
  };
  springs.rows = {between(0, 1), {{{above[3].first, 2, 1.0}}, 4, -1, {0, 0, 1}}, between(above.size() - 1, 0)};
  springs.stiffness.resize(3, 3);
  springs.stiffness.insert(0, 0) = stiff;
  springs.stiffness.insert(1, 1) = support;
  springs.stiffness.insert(2, 2) = soft;
  column.add_traction("upper.zmax", Point(0, 0, pull / Pieces::area));
  const auto problem = column.problem();
  const auto result = solved(problem);
  const auto states = spring_states(problem, result.solution.x);
  ASSERT_EQ(states.size(), 2U);
  const double held = reactions(problem, result.solution.x, 5)[4].force[2];
  EXPECT_LT(held, -0.1);
  EXPECT_NEAR(states[0].force + states[1].force, pull + held, 1e-8);
  EXPECT_GT(std::min(states[0].force, states[1].force), 0.1);
  EXPECT_NEAR(states[0].elongation, states[0].force / soft, 1e-12);
  EXPECT_NEAR(states[1].elongation, states[1].force / stiff, 1e-12);
  // And these are the distances of the places that they join.
  const auto u = problem.displacement(result.solution.x, result.solution.nu);
  const auto jumps = problem.jumps(u);
  const auto& own = problem.constraints().springs.own;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const int number = springs.rows[own[i]].spring;
    if (number < 0) continue;
    const double apart = jumps[problem.jump().ranges().springs + static_cast<Local>(i)];
    EXPECT_NEAR(apart, states[static_cast<std::size_t>(number)].elongation, 1e-8);
  }
}

// A load of -6 along z beside forces that are made up.
struct MadeUpForces {
  Pieces block{false};
  std::vector<Reaction> reactions{{{0, 0, force}, {}}};
  std::vector<contact::Resultant> contacts;
  std::vector<contact::Pair> pairs;
  std::vector<CouplingState> couplings;
  Rounding rounding;
  bool axisymmetric = false;

  MadeUpForces()
  {
    block.dirichlet_rows({{"lower.zmin", {0.0, 0.0, 0.0}}});
    block.add_traction("lower.zmax", Point(0, 0, -pressed));
  }
  Balance operator()() const
  {
    const auto problem = block.problem();
    return balance(problem, Vector(problem.jump().rows()), reactions, contacts, pairs, axisymmetric, couplings, rounding);
  }
};

TEST(Balances, SumWhatActsOverTheLargestForce)
{
  MadeUpForces forces;
  auto b = forces();
  EXPECT_NEAR((b.applied - Point(0, 0, -force)).norm(), 0, 1e-12);
  EXPECT_NEAR((b.supports - Point(0, 0, force)).norm(), 0, 1e-12);
  EXPECT_NEAR(b.largest, force, 1e-12);
  EXPECT_EQ(b.acting, b.largest);
  EXPECT_LT(b.difference, 1e-12);
  EXPECT_EQ(b.gauges.norm() + b.push_of_facets + b.obstacles.norm() + b.neighbours.norm(), 0);

  forces.reactions[0].force[2] = 0.9 * force;
  EXPECT_NEAR(forces().difference, 0.1, 1e-12);
  forces.reactions.push_back({{30, 40, 0}, {}});  // the largest of single supports counts, not of sums alone
  forces.reactions.push_back({{-30, -40, 0}, {}});
  b = forces();
  EXPECT_NEAR(b.largest, 50, 1e-12);
  EXPECT_NEAR(b.difference, 0.1 * force / 50, 1e-12);

  // In axisymmetry what pushes along x needs no support.
  forces.reactions.back().force[0] = 1000;
  EXPECT_NEAR(forces().difference, std::hypot(1030, 0.1 * force) / std::hypot(1030, 0.9 * force), 1e-12);
  forces.axisymmetric = true;
  EXPECT_NEAR(forces().difference * forces().largest, 0.1 * force, 1e-12);
}

TEST(Balances, KnowObstaclesNeighboursAndCouplings)
{
  MadeUpForces forces;
  forces.reactions[0].force = {0, 0, 1};
  forces.contacts.resize(3);
  forces.pairs.resize(3);
  forces.contacts[0].force = Point(0, 0, 5);
  forces.pairs[0].options.obstacle.emplace();
  forces.contacts[1].force = Point(0, 7, 0);  // between bodies: nothing from outside
  auto b = forces();
  EXPECT_EQ(b.obstacles, Point(0, 0, 5));
  EXPECT_NEAR(b.largest, 7, 1e-12);
  EXPECT_LT(b.difference, 1e-12);

  // A quarter's cut: what the next sector does to it, and it does to the sector before.
  forces.contacts[2].force = Point(2, 0, 0);
  forces.pairs[2].options.cyclic = mesh::RotationOptions{{0, 0, 1}, 90};
  b = forces();
  EXPECT_LT((b.neighbours - Point(2, 2, 0)).norm(), 1e-12);
  EXPECT_NEAR(b.difference, std::sqrt(8) / 7, 1e-12);

  // A fit's forces cancel: what warnings measure others by is a thousandth of their sizes, what is nothing a millionth.
  forces.contacts[1].sizes = 1e5;
  EXPECT_NEAR(forces().acting, 100, 1e-9);
  EXPECT_NEAR(forces().largest, 7, 1e-12);
  forces.contacts[1].sizes = 1e8;
  EXPECT_NEAR(forces().largest, 100, 1e-9);

  // The load at a rigid coupling is none of the nodes'; that of a distributing one is.
  forces.contacts[1].sizes = 0;
  forces.pairs[2].options.cyclic.reset();
  auto& coupling = forces.block.constraints.couplings.emplace_back();
  coupling.load = {0, 4, 0, 0, 0, 0};
  forces.couplings.push_back({{}, {0, 9, 0, 0, 0, 0}, {0, -4, 0, 0, 0, 0}});
  coupling.rigid = true;
  coupling.motion.fill(0.0);
  b = forces();
  EXPECT_LT((b.applied - Point(0, 4, -force)).norm(), 1e-12);
  EXPECT_LT((b.supports - Point(0, -4, 1)).norm(), 1e-12);
  EXPECT_NEAR(b.largest, 9, 1e-12);
  EXPECT_LT(b.difference, 1e-12);
  coupling.rigid = false;
  EXPECT_LT((forces().applied - Point(0, 0, -force)).norm(), 1e-12);

  forces.rounding.force = 60;
  EXPECT_NEAR(forces().largest, 60, 1e-12);
}

// Two nodes with k |u|, k |u|^2 / 2, |f|^2 / 2k and |f| / k by hand.
TEST(Roundings, AreSmallPartsOfWhatNodesWouldDoAlone)
{
  const Communicator alone(MPI_COMM_SELF);
  const std::vector<Eigen::VectorXd> u{(Eigen::VectorXd(6) << 3, 0, 4, 0, 0, 2).finished()};
  const std::vector<Eigen::VectorXd> f{(Eigen::VectorXd(6) << 0, 6, 8, 0, 0, 0).finished()};
  const std::vector<std::vector<double>> k{{20, 300}};
  auto r = rounding(u, f, k, 3, 1e-3, alone);
  EXPECT_NEAR(r.force, 1e-9 * (20 * 5 + 300 * 2), 1e-18);
  EXPECT_NEAR(r.energy, 1e-12 * (100 / 40.0), 1e-24);
  EXPECT_NEAR(r.length, 1e-5 * (10 / 20.0), 1e-18);
  EXPECT_NEAR(r.work, 1e-5 * (100 / 40.0), 1e-18);
  EXPECT_NEAR(r.moved, 1e-12 * 0.5 * (20 * 25 + 300 * 4), 1e-21);

  const std::vector<Eigen::VectorXd> unloaded{Eigen::VectorXd::Zero(6)};
  EXPECT_NEAR(rounding(u, unloaded, k, 3, 1e-3, alone).length, 1e-6 * 5, 1e-18);

  // At rest and unloaded what is left is a part of the model's size.
  const std::vector<Eigen::VectorXd> none{Eigen::VectorXd::Zero(6)};
  r = rounding(none, none, k, 3, 100, alone);
  EXPECT_NEAR(r.force, 300 * 1e-10, 1e-18);
  EXPECT_NEAR(r.energy, 0.5 * 300 * 1e-20, 1e-28);
  EXPECT_NEAR(r.length, 1e-10, 1e-20);
  EXPECT_EQ(r.work, 0);
  EXPECT_EQ(r.moved, 0);

  Rounding before{1, 0, 3, 4, 5};
  before.take({0, 2, 1, 9, 6});
  EXPECT_EQ(before.force, 1);
  EXPECT_EQ(before.energy, 2);
  EXPECT_EQ(before.length, 3);
  EXPECT_EQ(before.work, 4);  // that of this state alone
  EXPECT_EQ(before.moved, 6);
}

}  // namespace
}  // namespace mortise::post
