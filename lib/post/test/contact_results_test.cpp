// Contacts of known pressures, gaps and slips, and what their forces turn. The same on any ranks.
#include "post/contact_results.hpp"

#include "pieces.hpp"
#include "post/contact_checks.hpp"
#include "post/large_turns.hpp"

namespace mortise::post {
namespace {

constexpr double pressure_on_top = 3;

// Pressed alone: each node has the pressure of the load times its share of the section.
TEST(ContactResults, OfAPressedColumn)
{
  Pieces column;
  column.guide();
  const auto pairs = column.touch();
  column.add_traction("upper.zmax", Point(0, 0, -pressure_on_top));
  const auto problem = column.problem();
  const auto result = solved(problem);
  const auto& lambda = result.solution.x;
  const auto& nu = result.solution.nu;
  const auto u = problem.displacement(lambda, nu);
  const auto results = contact_results(problem, lambda, nu, result.slip_bounds, u, pairs, 0);
  EXPECT_EQ(column.comm.sum(static_cast<long long>(results.states.size())), 15);
  for (std::size_t i = 0; i < results.states.size(); ++i) {
    const auto& point = results.states[i];
    EXPECT_EQ(point.status, contact::Status::slip);
    EXPECT_NEAR(point.force, pressure_on_top * Pieces::share(problem.constraints().contacts.nodes[i].at), 1e-8);
    EXPECT_LT((point.force_on_secondary - Point(0, 0, point.force)).norm(), 1e-12);
    EXPECT_NEAR(point.gap, 0, 1e-10);
  }
  ASSERT_EQ(results.resultants.size(), 1U);
  EXPECT_LT((results.resultants[0].force - Point(0, 0, pressure_on_top * Pieces::area)).norm(), 1e-8);
  EXPECT_NEAR(results.resultants[0].area, Pieces::area, 1e-10);
  EXPECT_EQ(results.resultants[0].slip, 15);
  for (const double p : results.surfaces.at(0).pressure) EXPECT_NEAR(p, pressure_on_top, 1e-8);
  EXPECT_LT(results.penetration, 1e-10);
  EXPECT_LT(results.work_of_gaps, 1e-9);
  EXPECT_EQ(results.tensions, std::vector<double>{0});

  // Both sides feel the same at the same places: nothing is lost of a moment.
  const auto moments = contact_moments(problem, lambda, column.decomposition, fem::Kinematics::solid, pairs, results.states);
  ASSERT_EQ(moments.size(), 1U);
  EXPECT_LT(moments[0].lost, 1e-8);
  EXPECT_NEAR(moments[0].sizes, pressure_on_top * Pieces::area, 1e-8);
}

// Forces and displacements that are made up, of rows node by node: normal (0, 0, -1) and two tangents.
struct MadeUp {
  Pieces column;
  std::vector<contact::Pair> pairs;
  Eigen::VectorXd forces;
  double gap;

  explicit MadeUp(bool bonded, double apart = 0, contact::Law law = contact::Law::coulomb) : column(true, apart), gap(apart)
  {
    column.dirichlet_rows({{"lower.zmin", {0.0, 0.0, 0.0}}, {"upper.zmax", {0.0, 0.0, 0.0}}});
    pairs = column.touch();
    pairs[0].options.law = bonded ? contact::Law::bonded : law;
    column.constraints.contacts = {};
    column.join("upper.zmin", "lower.zmax", bonded);
    auto& contacts = column.constraints.contacts;
    for (auto& bound : contacts.rows.bound) bound = 0;
    const auto nodes = column.nodes_of("upper.zmin");
    for (auto& node : contacts.nodes) {
      contacts.rows.bound[node.row] = node.gap = apart;
      for (const auto& n : nodes)
        if (n.id == node.node) node.at = Point(n.x, n.y, 1 + apart);
    }
  }
  // f(place) of each node: forces of its normal row and its tangential ones.
  template <class Force>
  Vector multipliers(const feti::DualProblem& problem, const Force& f) const
  {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(problem.jump().ranges().end);
    for (std::size_t i = 0; i < problem.node_rows().size(); ++i)
      all.segment(problem.node_rows()[i].normal, 3) = Point(f(problem.constraints().contacts.nodes[i].at));
    return problem.multipliers(all);
  }
  ContactResults results(const feti::DualProblem& problem, const Vector& lambda, const std::vector<Eigen::VectorXd>& u,
                         double largest = 0, double slip_bound = std::numeric_limits<double>::infinity()) const
  {
    const std::vector<double> bounds(problem.set().discs().size(), slip_bound);
    return contact_results(problem, lambda, Eigen::VectorXd::Zero(problem.system().kernel_dimension()), bounds, u, pairs,
                           largest);
  }
};

TEST(ContactResults, AreThoseOfRowsAndJumps)
{
  MadeUp contact(false, 0.01);
  const auto problem = contact.column.problem();
  // Pressed with 4 for x < 1.9 and pulled by nothing elsewhere, along the first tangent (0.6, 0.8, 0) by 1.
  const auto lambda =
      contact.multipliers(problem, [](const Point& x) { return x[0] < 1.9 ? Point(4, 1, 0) : Point(Point::Zero()); });
  // The upper block comes down by more than the gap, and slides.
  const auto u = contact.column.displacement(
      [](const Point&, int body) { return body == 0 ? Point(0, 0, 0.002) : Point(0.03, 0.04, -0.014); });
  const auto results = contact.results(problem, lambda, u);
  long long pressed = 0;
  for (std::size_t i = 0; i < results.states.size(); ++i) {
    const auto& p = results.states[i];
    const bool closed = problem.constraints().contacts.nodes[i].at[0] < 1.9;
    pressed += closed;
    EXPECT_EQ(p.status, closed ? contact::Status::stick : contact::Status::open);
    EXPECT_NEAR(p.force, closed ? 4 : 0, 1e-12);
    EXPECT_LT((p.force_on_secondary - (closed ? Point(-0.6, -0.8, 4) : Point(Point::Zero()))).norm(), 1e-12);
    EXPECT_NEAR(p.gap, 0.01 - 0.016, 1e-12);
    EXPECT_LT((p.slip - Point(0.03, 0.04, 0)).norm(), 1e-12);
  }
  EXPECT_EQ(contact.column.comm.sum(pressed), 10);
  EXPECT_LT((results.resultants[0].force - 10 * Point(-0.6, -0.8, 4)).norm(), 1e-11);
  EXPECT_EQ(results.resultants[0].open, 5);
  EXPECT_EQ(results.resultants[0].stick, 10);
  EXPECT_NEAR(results.resultants[0].sizes, 10 * std::sqrt(17), 1e-11);
  EXPECT_NEAR(results.penetration, 0.006, 1e-12);
  EXPECT_NEAR(results.work_of_gaps, 10 * 0.006 * 4, 1e-12);

  // Within bounds of 2 nodes stick; on them they slip, and a gap that opens is no penetration.
  for (const double bound : {2.0, 1.0}) {
    const auto rest =
        contact.results(problem, lambda, contact.column.displacement([](const Point&, int) { return Point(0, 0, 0); }), 0, bound);
    EXPECT_EQ(rest.resultants[0].stick, bound > 1 ? 10 : 0);
    EXPECT_EQ(rest.resultants[0].slip, bound > 1 ? 0 : 10);
    EXPECT_EQ(rest.penetration, 0);
    EXPECT_NEAR(rest.work_of_gaps, 10 * 0.01 * 4, 1e-12);
  }
}

// What had slipped before this load step counts from there.
TEST(ContactResults, SlipCountsFromTheStepBefore)
{
  MadeUp contact(false);
  auto& contacts = contact.column.constraints.contacts;
  contacts.slipped.assign(contacts.rows.size(), 0.0);
  for (const auto& node : contacts.nodes) contacts.slipped[node.row + 1] = contacts.rows.bound[node.row + 1] = 0.05;
  // Beside it supports that moved by 0.02 along the first tangent since the rows were made.
  for (const auto& node : contacts.nodes) contacts.rows.bound[node.row + 1] += 0.02;
  const auto problem = contact.column.problem();
  const auto u =
      contact.column.displacement([](const Point&, int body) { return body == 0 ? Point(0, 0, 0) : Point(0.06, 0.08, 0); });
  for (const auto& p : contact.results(problem, Vector(problem.jump().rows()), u).states)
    EXPECT_LT((p.slip - 0.08 * Point(0.6, 0.8, 0)).norm(), 1e-12);
}

TEST(ContactResults, ForcesOfRoundingAreNone)
{
  const MadeUp contact(false), bonded(true);
  const auto results = [](const MadeUp& model, double size, double before) {
    const auto problem = model.column.problem();
    const auto lambda = model.multipliers(problem, [&](const Point&) { return Point(size, 0, 0); });
    return model.results(problem, lambda, model.column.displacement([](const Point&, int) { return Point(0, 0, 0); }), before);
  };
  EXPECT_EQ(results(contact, 1.1e-10, 1).resultants[0].open, 0);
  EXPECT_EQ(results(contact, 0.9e-10, 1).resultants[0].open, 15);
  EXPECT_EQ(results(contact, 0.9e-10, 1).resultants[0].sizes, 0);
  EXPECT_EQ(results(contact, 0.9e-10, 0).resultants[0].open, 0);  // nothing larger is known
  EXPECT_NEAR(results(bonded, 0.9e-10, 1).resultants[0].sizes, 15 * 0.9e-10, 1e-16);
}

// Bonded nodes pull by 5 on areas of 1, and do not penetrate whatever they do.
TEST(ContactResults, BondsHaveTensions)
{
  const MadeUp bond(true);
  const auto problem = bond.column.problem();
  const auto lambda = bond.multipliers(problem, [](const Point& x) { return Point(x[1] > 2 ? -5 : 1, 0, 0); });
  const auto u = bond.column.displacement([](const Point&, int body) { return Point(0, 0, -0.1 * body); });
  const auto results = bond.results(problem, lambda, u);
  EXPECT_NEAR(results.tensions.at(0), 5, 1e-12);
  EXPECT_EQ(results.resultants[0].stick, 15);
  EXPECT_EQ(results.penetration, 0);
  EXPECT_EQ(results.work_of_gaps, 0);
}

// A bond over a gap that carries a shear force T: the two sides lose T times the gap, and 15 equal forces turn by their radius of
// gyration, or by the size of a node's own area where that is larger.
TEST(ContactMoments, AreLostAcrossGaps)
{
  constexpr double gap = 0.2, shear = 0.4;
  double square = 0;  // of distances from the middle
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 5; ++j) square += std::pow(0.5 * (i - 1), 2) + std::pow(0.5 * (j - 2), 2);
  for (const auto& [apart, of_node] : {std::pair(0.0, 1.0), std::pair(gap, 1.0), std::pair(gap, 0.01)}) {
    MadeUp bond(true, apart);
    for (auto& node : bond.column.constraints.contacts.nodes) node.area = of_node;
    const auto problem = bond.column.problem();
    const auto lambda = bond.multipliers(problem, [&](const Point&) { return Point(0, shear, 0); });
    const auto results =
        bond.results(problem, lambda, bond.column.displacement([](const Point&, int) { return Point(0, 0, 0); }));
    const auto found =
        contact_moments(problem, lambda, bond.column.decomposition, fem::Kinematics::solid, bond.pairs, results.states);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].lost, 15 * shear * apart, 1e-10);
    EXPECT_NEAR(found[0].sizes, 15 * shear, 1e-10);
    EXPECT_NEAR(found[0].scale, 15 * shear * std::max(std::sqrt(square / 15), std::sqrt(of_node)), 1e-10);
    EXPECT_EQ(lost_moments(found, bond.pairs, 15 * shear).size(), apart > 0 ? 1U : 0U);

    auto obstacle = bond.pairs;
    obstacle[0].options.obstacle.emplace();
    EXPECT_EQ(
        contact_moments(problem, lambda, bond.column.decomposition, fem::Kinematics::solid, obstacle, results.states)[0].lost, 0);
  }
}

// A force that goes into a support at the lower side is none of the nodes' there, and counts where the support is.
TEST(ContactMoments, CountWhatGoesIntoSupports)
{
  MadeUp bond(true);
  auto& contacts = bond.column.constraints.contacts;
  const double height = bond.column.comm.root() ? 3 : 0;
  if (bond.column.comm.root()) contacts.prescribed.push_back({contacts.nodes[0].row, 0, 0, -1.0, {0, 0, height}});
  const auto problem = bond.column.problem();
  const Vector all = bond.multipliers(problem, [&](const Point&) { return Point(2, 0, 0); });
  const auto results = bond.results(problem, all, bond.column.displacement([](const Point&, int) { return Point(0, 0, 0); }));
  EXPECT_NEAR(
      contact_moments(problem, all, bond.column.decomposition, fem::Kinematics::solid, bond.pairs, results.states)[0].lost, 2 * 3,
      1e-10);
}

// Of a modulus of 1e5 and a size of 10 an overlap of 0.01 presses with 1e2: a thousand millionth of that is none.
TEST(LooseFits, PressNowhere)
{
  const MadeUp bond(true);
  auto pairs = bond.pairs;
  std::vector<contact::ContactNodeState> points(1);
  points[0].area = 2;
  const auto found = [&](double pressure, contact::Law law, double interference) {
    points[0].force = pressure * points[0].area;
    pairs[0].options.law = law;
    pairs[0].options.interference = interference;
    return loose_fits(points, pairs, 1e5, 10, bond.column.comm).size();
  };
  EXPECT_EQ(found(0.9e-7, contact::Law::coulomb, 0.01), 1U);
  EXPECT_EQ(found(1.1e-7, contact::Law::coulomb, 0.01), 0U);
  EXPECT_EQ(found(0, contact::Law::coulomb, 0), 0U);
  EXPECT_EQ(found(0, contact::Law::coulomb, -0.01), 0U);
  EXPECT_EQ(found(0, contact::Law::frictionless, 0.01), 0U);
}

// 100 on a modulus of 1e4 and an area of 4: 5e-3 are usual, 5e-8 the limit. A bolt that nobody tightens has nothing to shorten.
TEST(TiedPreloads, ShortenNothing)
{
  std::vector<contact::Pair> pairs(1);
  pairs[0].options.name = "cut";
  std::vector<constraint::PretensionSection> sections(1);
  sections[0].preload = {0, "cut", 100, 0};
  const auto found = [&](double shortening) {
    return tied_preloads(sections, std::vector{shortening}, std::vector{4.0}, pairs, 1e4).size();
  };
  EXPECT_EQ(found(4.9e-8), 1U);
  EXPECT_EQ(found(5.1e-8), 0U);
  sections[0].preload.force = 0;
  EXPECT_EQ(found(0), 0U);
}

TEST(LostMoments, FromAHundredth)
{
  std::vector<contact::Pair> pairs(2);
  pairs[0].options.name = "little";
  pairs[1].options.name = "much";
  const auto found = [&](ContactMoment a, ContactMoment b, double forces) {
    return lost_moments(std::vector{a, b}, pairs, forces);
  };
  EXPECT_TRUE(found({0.0099, 1, 1}, {0, 1, 1}, 1).empty());
  EXPECT_TRUE(found({0.0101, 1, 1}, {0.5, 1, 1}, 2e6).empty());  // forces that are nothing beside others
  const auto both = found({0.02, 1, 1}, {0.03, 1, 4}, 1);
  ASSERT_EQ(both.size(), 1U);
  EXPECT_EQ(both[0].kind, "lost_moment");
  EXPECT_EQ(both[0].contact, "much");
  EXPECT_NEAR(both[0].value, 0.03, 1e-15);
  EXPECT_NEAR(both[0].limit, 0.01, 1e-15);
  EXPECT_NE(both[0].text.find("3 %"), std::string::npos) << both[0].text;
  EXPECT_NE(both[0].text.find("1 other contacts"), std::string::npos) << both[0].text;
}

// One open node beside closed ones, on every rank.
TEST(FrictionsAcrossGaps, FromAHundredthOfTrescasForces)
{
  const Communicator comm;
  std::vector<contact::Pair> pairs(1);
  pairs[0].options.name = "joint";
  pairs[0].options.law = contact::Law::tresca;
  const auto found = [&](double open, double gap, double forces = 1) {
    std::vector<contact::ContactNodeState> points(3);
    points[0].force_on_secondary = Point(0, open, 0);
    points[0].gap = gap;
    points[1].status = contact::Status::slip;
    points[1].force_on_secondary = Point(0, 0, 99);
    points[2].gap = 7;  // open, and bears nothing
    return frictions_across_gaps(points, pairs, forces, comm);
  };
  EXPECT_TRUE(found(0.99, 0.1).empty());
  const auto over = found(1.01, 0.1);
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0].kind, "friction_across_gap");
  EXPECT_EQ(over[0].contact, "joint");
  EXPECT_NEAR(over[0].value, 1.01 * comm.size(), 1e-12);
  EXPECT_NEAR(over[0].limit, 1.0001 * comm.size(), 1e-12);
  EXPECT_NE(over[0].text.find("gaps of up to 0.1:"), std::string::npos) << over[0].text;
  EXPECT_TRUE(found(1.01, 0.1, 1e9).empty());
  pairs[0].options.law = contact::Law::coulomb;
  EXPECT_TRUE(found(50, 0.1).empty());
}

// The upper block, 1 high, has turned by phi about x: a rotation would make it phi^2 / 2 lower than the linear displacement,
// whose top a support holds, and the joint feels that. What pushes the top down instead gives way.
TEST(LargeTurns, AreFeltBetweenWhatIsHeld)
{
  constexpr double phi = 0.02, force = 4, nodes = 15;
  const std::vector<double> energies{1.0, 2.0};
  const auto found = [&](bool held) {
    MadeUp contact(false);
    if (!held) contact.column.dirichlet_rows({{"lower.zmin", {0.0, 0.0, 0.0}}});
    const auto problem = contact.column.problem();
    const auto lambda = contact.multipliers(problem, [&](const Point&) { return Point(force, 0, 0); });
    const auto u = contact.column.displacement([&](const Point& x, int body) {
      return body == 0 ? Point(Point::Zero()) : Point(Point(phi, 0, 0).cross(x - Point(1.5, 1.5, 1.5)));
    });
    const auto states = contact.results(problem, lambda, u).states;
    return large_turn(problem, lambda, contact.column.decomposition, fem::Kinematics::solid, u, contact.pairs, states, energies);
  };
  const double change = nodes * force * phi * phi / 2 / (2 * 3);
  const auto turn = found(true);
  EXPECT_NEAR(turn.change, change, 0.02 * change);
  EXPECT_EQ(turn.sign, -1);
  EXPECT_EQ(turn.body, 1);
  EXPECT_NEAR(turn.angle, phi, 1e-12);
  EXPECT_NEAR(turn.largest.at[2], 1, 1e-12);
  EXPECT_LT(found(false).change, 1e-6 * change);
}

TEST(LargeTurns, WarnFromTwoPerCentOn)
{
  const std::vector<contact::Pair> pairs(1);
  const auto told = [&](double change) {
    return large_turns({change, -1, {change, Point::Zero(), 0}, 1, 0.02}, pairs, {"lower", "upper"});
  };
  EXPECT_TRUE(told(0.0199).empty());
  const auto warnings = told(0.0201);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].kind, "large_turn");
  EXPECT_EQ(warnings[0].body, "upper");
  EXPECT_NE(warnings[0].text.find("too large"), std::string::npos);
}

}  // namespace
}  // namespace mortise::post
