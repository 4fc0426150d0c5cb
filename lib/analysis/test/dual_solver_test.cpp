// A block that stands free on another one, frictionless, with Tresca and with Coulomb friction: every solver of the table,
// through the whole dual problem, against proximal gradient steps on the assembled matrix in displacements, which knows neither
// multipliers nor subdomains.
#include "analysis/dual_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/error.hpp"
#include "testing/proximal_gradient.hpp"
#include "testing/stack.hpp"

namespace mortise::analysis {
namespace {

using friction::by_proximal_gradient;
using friction::forces_of;
using friction::Law;
using friction::Reference;
using LawKind = Law::Kind;

constexpr std::size_t contact_points = 16;  // of PushedStack

// Nodal force at a point on top: pressed harder towards x = 1, and pushed along x.
Point force_at(const Point& at, double push)
{
  return {push, 0, -0.3 - 1.5 * std::max(at[0] - 0.3, 0.0)};
}

struct PushedStack : feti::Stack {
  PushedStack(double push, bool tangents, int pieces, MPI_Comm mpi = MPI_COMM_WORLD) : Stack({1, 3, pieces}, 100, mpi)
  {
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const auto& points = decomposition.subdomains[s].mesh.points;
      for (std::size_t n = 0; n < points.size(); ++n)
        if (points[n][2] > 2 - 1e-9) load[s].segment(3 * static_cast<Eigen::Index>(n), 3) += force_at(points[n], push);
    }
    dirichlet_rows({{"lower.zmin", {0, 0, 0}}});
    join("upper.zmin", "lower.zmax", false, tangents);
  }
};

class Displacements {
 public:
  // Relative displacements w of the upper block's contact nodes, all others eliminated: S w - c are minus the contact forces.
  explicit Displacements(double push)
  {
    const PushedStack stack(push, true, 1, MPI_COMM_SELF);
    const auto below = stack.nodes_of("lower.zmax"), above = stack.nodes_of("upper.zmin");
    points_ = static_cast<Eigen::Index>(above.size());
    // Unknowns: w, then all displacements that are free, those of the lower block's contact nodes among them.
    std::map<Global, Eigen::Index> place;
    Eigen::Index count = 3 * points_;
    for (const auto& s : stack.decomposition.subdomains)
      for (std::size_t n = 0; n < s.mesh.node_id.size(); ++n) {
        const Global id = s.mesh.node_id[n];
        const bool upper_contact = std::any_of(above.begin(), above.end(), [&](const auto& node) { return node.id == id; });
        if (upper_contact || s.mesh.points[n][2] < 1e-9) continue;
        place.emplace(id, count);
        count += 3;
      }
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(count);
    for (std::size_t s = 0; s < stack.decomposition.subdomains.size(); ++s) {
      const auto& mesh = stack.decomposition.subdomains[s].mesh;
      const Eigen::MatrixXd own = fem::stiffness(mesh, fem::Material{100, 0.3, 0, 0}, fem::Kinematics::solid);
      Eigen::MatrixXd t = Eigen::MatrixXd::Zero(own.rows(), count);  // displacements of the block from the unknowns
      for (std::size_t n = 0; n < mesh.node_id.size(); ++n) {
        const auto row = 3 * static_cast<Eigen::Index>(n);
        if (const auto at = place.find(mesh.node_id[n]); at != place.end()) t.block(row, at->second, 3, 3).setIdentity();
        for (Eigen::Index p = 0; p < points_; ++p)
          if (above[static_cast<std::size_t>(p)].id == mesh.node_id[n]) {
            t.block(row, 3 * p, 3, 3).setIdentity();
            t.block(row, place.at(below[static_cast<std::size_t>(p)].id), 3, 3).setIdentity();
          }
      }
      const Eigen::MatrixXd whole = own.triangularView<Eigen::Lower>();
      k += t.transpose() * whole.selfadjointView<Eigen::Lower>() * t;
      f += t.transpose() * stack.load[s];
    }
    const Eigen::Index w = 3 * points_, rest = count - w;
    const Eigen::LLT<Eigen::MatrixXd> factor(k.bottomRightCorner(rest, rest));
    const Eigen::MatrixXd coupling = factor.solve(k.bottomLeftCorner(rest, w));
    s_ = k.topLeftCorner(w, w) - k.topRightCorner(w, rest) * coupling;
    c_ = f.head(w) - coupling.transpose() * f.tail(rest);
    // In the frame of each point.
    Eigen::MatrixXd frame(3, 3);
    for (int i = 0; i < 3; ++i) frame.col(i) = PushedStack::frame()[static_cast<std::size_t>(i)];
    for (Eigen::Index p = 0; p < points_; ++p) {
      s_.middleRows(3 * p, 3) = (frame.transpose() * s_.middleRows(3 * p, 3)).eval();
      s_.middleCols(3 * p, 3) = (s_.middleCols(3 * p, 3) * frame).eval();
      c_.segment(3 * p, 3) = (frame.transpose() * c_.segment(3 * p, 3)).eval();
    }
  }

  Reference solve(Law law) const { return by_proximal_gradient(s_, c_, law, Eigen::VectorXd::Zero(points_)); }

 private:
  Eigen::Index points_ = 0;
  Eigen::MatrixXd s_;
  Eigen::VectorXd c_;
};

// Once for all solvers, by one rank. Collective.
const Reference& reference(const Law& law, double push)
{
  static std::map<LawKind, Reference> known;
  if (const auto found = known.find(law.kind); found != known.end()) return found->second;
  const Communicator comm;
  std::vector<double> forces, bounds;
  if (comm.root()) {
    const Reference own = Displacements(push).solve(law);
    forces.assign(own.forces.begin(), own.forces.end());
    bounds.assign(own.bounds.begin(), own.bounds.end());
  }
  comm.broadcast(forces);
  comm.broadcast(bounds);
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  return known.emplace(law.kind, Reference{vector(forces), vector(bounds)}).first->second;
}

struct Case {
  const char* algorithm;
  Law law;
  double push;
  int most;  // products
};
std::ostream& operator<<(std::ostream& out, const Case& c)
{
  return out << c.algorithm << " law " << static_cast<int>(c.law.kind) << " push " << c.push;
}

std::vector<Case> cases()
{
  std::vector<Case> all;
  for (const auto& [algorithm, most] : {std::pair("face_newton", 60), std::pair("smalse", 250), std::pair("direct", 10)}) {
    all.push_back({algorithm, {LawKind::frictionless, 0}, 0, most});
    all.push_back({algorithm, {LawKind::tresca, 0.12}, 0.1, most});
    all.push_back({algorithm, {LawKind::coulomb, 0.4}, 0.15, most});
  }
  return all;
}

class TwoBlocks : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(SolversAndLaws, TwoBlocks, testing::ValuesIn(cases()));

TEST_P(TwoBlocks, HaveTheForcesOfTheAssembledMatrix)
{
  const auto [algorithm, law, push, most] = GetParam();
  const Reference& expected = reference(law, push);
  const double size = expected.forces.norm();
  ASSERT_GT(size, 1);
  // The test tells something only where the law has its say.
  int open = 0, slips = 0, sticks = 0;
  for (Eigen::Index p = 0; p < expected.bounds.size(); ++p) {
    if (expected.forces[3 * p] < 1e-9) {
      ++open;
      EXPECT_LT(std::abs(expected.forces[3 * p]), 1e-9);
    }
    const double tangential = expected.forces.segment(3 * p + 1, 2).norm();
    EXPECT_LE(tangential, expected.bounds[p] + 1e-9);
    (tangential >= expected.bounds[p] - 1e-9 ? slips : sticks) += expected.bounds[p] > 1e-6;
  }
  EXPECT_GE(open, 2);
  if (law.kind != LawKind::frictionless) {
    EXPECT_GE(slips, 2);
    EXPECT_GE(sticks, 2);
  }

  const bool slow = algorithm == std::string("smalse");
  const double tolerance = slow ? 1e-7 : 1e-9;
  for (const int pieces : {1, 3}) {
    const PushedStack stack(push, law.kind != LawKind::frictionless, pieces);
    const auto problem = stack.problem();
    qp::Options options;
    options.algorithm = algorithm;
    options.tolerance.value = tolerance;
    DualSolver solver(problem.shared_system(), {law}, {tolerance, 200}, options);
    const auto result = solver.solve(problem, {}, {}, {});
    EXPECT_TRUE(result.converged) << pieces;
    EXPECT_LE(result.applications, most) << pieces;
    const Eigen::VectorXd forces = forces_of(problem, result.solution.x, contact_points);
    EXPECT_LT((forces - expected.forces).norm(), (slow ? 1e-4 : 1e-6) * size) << pieces;
    // The bounds of the laws, at the solution.
    const auto bounds = friction::slip_bounds(problem, {law}, &result.solution.x);
    for (std::size_t i = 0; i < problem.node_rows().size(); ++i) {
      const auto& rows = problem.node_rows()[i];
      if (rows.disc < 0) continue;
      const auto p = static_cast<Eigen::Index>(i) * stack.comm.size() + stack.comm.rank();
      EXPECT_NEAR(bounds[static_cast<std::size_t>(rows.disc)], expected.bounds[p], slow ? 1e-4 : 1e-6);
    }
  }
}

// Pressed by 9.5 in all, of which friction holds 0.3.
TEST(TwoBlocksPushedTooHard, AreNoEquilibrium)
{
  for (const char* algorithm : {"face_newton", "smalse"}) {
    const PushedStack stack(0.5, true, 1);
    const auto problem = stack.problem();
    qp::Options options;
    options.algorithm = algorithm;
    options.tolerance.value = 1e-6;
    DualSolver solver(problem.shared_system(), {{LawKind::coulomb, 0.3}}, {1e-4, 50}, options);
    try {
      solver.solve(problem, {}, {}, {});
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
      EXPECT_NE(std::string(error.what()).find("upper"), std::string::npos) << error.what();
    }
  }
}

// Who waits for a few products is told that it might go on; who gave their number is told the key.
TEST(TwoBlocksWithFewProducts, EndWithoutASolution)
{
  const Law law{LawKind::coulomb, 0.4};
  for (const bool waiting : {true, false}) {
    const PushedStack stack(0.15, true, 3);
    const auto problem = stack.problem();
    qp::Options options;
    options.algorithm = "face_newton";
    options.tolerance.value = 1e-10;
    constexpr int few = 15;
    if (!waiting) options.max_multiplications.value = few;
    DualSolver solver(problem.shared_system(), {law}, {1e-9, 50}, options);
    const auto result = solver.solve(problem, {}, {}, {}, waiting ? std::optional<qp::Patience>(few) : std::nullopt);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.gave_up, waiting);
    EXPECT_LE(result.applications, few + 3);
    EXPECT_EQ(result.limit.find("solver.max_multiplications"), 0U);
  }
}

// The second load step is the first one again: it starts from its solution and has next to nothing to do.
TEST(TwoBlocksAgain, StartFromWhatIsKnown)
{
  const PushedStack stack(0.15, true, 3);
  const auto problem = stack.problem();
  qp::Options options;
  options.algorithm = "face_newton";
  options.tolerance.value = 1e-8;
  DualSolver solver(problem.shared_system(), {{LawKind::coulomb, 0.4}}, {1e-6, 50}, options);
  const auto first = solver.solve(problem, {}, {}, {});
  ASSERT_TRUE(first.converged);
  const auto second = solver.solve(problem, first.solution, {}, {});
  EXPECT_TRUE(second.converged);
  EXPECT_LE(second.applications, std::min(first.applications / 2, 8));
  const Eigen::VectorXd a = forces_of(problem, first.solution.x, contact_points),
                        b = forces_of(problem, second.solution.x, contact_points);
  EXPECT_GT(a.norm(), 1);
  EXPECT_LT((a - b).norm(), 1e-6 * a.norm());
}

}  // namespace
}  // namespace mortise::analysis
