// A column of two halves, 5 high, of section 1, tied node by node across a cut that is drawn together.
#include "constraint/preload.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.hpp"
#include "constraint/supports.hpp"
#include "fem/stiffness.hpp"
#include "feti/dual_problem.hpp"
#include "partition/decompose.hpp"
#include "qp/face_newton.hpp"
#include "qp/smalse.hpp"

namespace mortise::feti {
namespace {

constexpr double young = 1000, force = 50, shortening = force * 5 / young;

struct Column {
  Communicator comm;
  Timers timers;
  Log log{comm, nullptr};
  Context context{comm, log, timers};
  partition::Decomposition decomposition;
  std::unique_ptr<partition::NodeDirectory> directory;
  partition::Interface interface;
  Floating floating;
  std::vector<Eigen::VectorXd> load;
  constraint::Constraints constraints;

  // Held along z at its ends, or at the lower one alone; nothing keeps it from moving sideways.
  Column(const constraint::Preload& preload, bool both_ends) : comm(MPI_COMM_WORLD)
  {
    mesh::Options mesh;
    mesh.blocks["lower"] = {{0, 0, 0}, {1, 1, 2}, {2, 2, 4}, "hex8"};
    mesh.blocks["upper"] = {{0, 0, 2}, {1, 1, 3}, {2, 2, 6}, "hex8"};
    partition::Options options;
    options.method = "grid";
    options.counts["lower"] = {1, 1, 2};
    options.counts["upper"] = {1, 1, 3};
    decomposition = partition::decompose(mesh, options, 3, context);
    Subdomains subdomains;
    for (const auto& s : decomposition.subdomains) {
      auto stiffness = fem::stiffness(s.mesh, fem::Material{young, 0.3, 0, 0}, fem::Kinematics::solid);
      floating.nodal_stiffness.push_back(nodal_stiffness(stiffness, 3));
      load.emplace_back(Eigen::VectorXd::Zero(stiffness.cols()));
      subdomains.push_back(std::make_shared<ElasticSubdomain>(
          std::move(stiffness), fem::rigid_motions(s.mesh.points, fem::Kinematics::solid), s.mesh.points, 3, "cholmod"));
    }
    directory = std::make_unique<partition::NodeDirectory>(decomposition, floating.nodal_stiffness, comm);
    interface = partition::find_interface(decomposition, *directory, comm);
    floating.clusters = Clusters(decomposition, interface, subdomains, floating.nodal_stiffness, fem::Kinematics::solid);
    std::vector<constraint::SupportOptions> supports{{"lower.zmin", {std::nullopt, std::nullopt, 0.0}}};
    std::vector<std::vector<Global>> nodes{side("lower.zmin").node_id};
    if (both_ends) {
      supports.push_back({"upper.zmax", {std::nullopt, std::nullopt, 0.0}});
      nodes.push_back(side("upper.zmax").node_id);
    }
    constraints.held = constraint::hold(supports, nodes, 3, comm);
    tie();
    constraints.cuts = constraint::find_cuts(constraints.contacts, std::vector{preload}, false, comm);
  }

  mesh::Surface side(const std::string& name) const
  {
    const auto& names = decomposition.catalogue.boundaries;
    const auto index = static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
    return partition::boundary_surface(decomposition, index, {true, true});
  }

  struct Node {
    double x, y;
    Global id;
  };
  // All nodes of a side, the same order on both sides of the cut.
  std::vector<Node> nodes_of(const std::string& name) const
  {
    const auto surface = side(name);
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < surface.points.size(); ++i)
      nodes.push_back({surface.points[i][0], surface.points[i][1], surface.node_id[i]});
    nodes = comm.all_gather(nodes);
    std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
    nodes.erase(std::unique(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.id == b.id; }), nodes.end());
    return nodes;
  }

  // The upper half is the secondary side: its normal is -z. Rows stand on the ranks in turn.
  void tie()
  {
    const auto above = nodes_of("upper.zmin"), below = nodes_of("lower.zmax");
    auto& contacts = constraints.contacts;
    for (std::size_t i = 0; i < above.size(); ++i) {
      if (static_cast<int>(i) % comm.size() != comm.rank()) continue;
      const std::vector<Point> frame{Point(0, 0, -1), Point(0.6, 0.8, 0), Point(0.8, -0.6, 0)};
      contacts.points.push_back({0, above[i].id, 1, frame[0], {frame[1], frame[2]}, contacts.rows.size()});
      contacts.bonded.push_back(true);
      for (const auto& axis : frame) {
        for (int c = 0; c < 3; ++c)
          if (axis[c] != 0) {
            contacts.rows.entries.push_back({above[i].id, c, axis[c]});
            contacts.rows.entries.push_back({below[i].id, c, -axis[c]});
          }
        contacts.rows.close(0);
      }
    }
  }
};

qp::Solution solve(const DualProblem& problem, const std::string& algorithm)
{
  qp::Hessian hessian(problem.hessian(), 1000);
  Vector driven(problem.linear().getMap());
  if (problem.pull()) hessian.apply(*problem.pull(), driven);
  const qp::Problem programme{hessian, problem.linear(), problem.equality(), problem.set(), problem.pull() ? &driven : nullptr};
  return algorithm == "smalse" ? qp::smalse(programme, {}, 1e-10, {})
                               : qp::FaceNewton(programme, problem.preconditioner()).solve({}, {1e-10, {}}, nullptr, {});
}

// Tension over the cut from the multipliers.
double tension(const DualProblem& problem, const Vector& lambda)
{
  double sum = 0;
  for (const auto& [row, part] : problem.constraints().cuts[0].rows) {
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
  const DualProblem problem(column.decomposition, *column.directory, column.interface, column.constraints, column.floating,
                            column.load, {}, column.context);
  EXPECT_EQ(problem.kernel_dimension(), 5 * 6);
  EXPECT_EQ(problem.equality().size(), 5 * 6 + 1);
  const auto solution = solve(problem, GetParam());
  ASSERT_TRUE(solution.converged);
  EXPECT_NEAR(tension(problem, solution.x), force, 1e-10 * force);
  const auto found = problem.shortenings(solution.nu);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0], shortening, 1e-8 * shortening);
  const auto u = problem.displacement(solution.x, solution.nu);
  EXPECT_LT(problem.imbalance(u, solution.x), 1e-10);
  // u_z rises to force / young * 2 below the cut, and from there as much less as it is drawn together.
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
  const DualProblem problem(column.decomposition, *column.directory, column.interface, column.constraints, column.floating,
                            column.load, {}, column.context);
  EXPECT_EQ(problem.equality().size(), 5 * 6);
  EXPECT_EQ(problem.pull(), nullptr);
  const auto solution = solve(problem, GetParam());
  ASSERT_TRUE(solution.converged);
  EXPECT_NEAR(tension(problem, solution.x), force, 1e-8 * force);
  EXPECT_EQ(problem.shortenings(solution.nu)[0], shortening);
}

// The upper half follows the pull and nothing stops it: the bond does not, for it is what is drawn together.
TEST(Preload, AHalfThatNothingStopsIsNamed)
{
  const Column column({0, "cut", force}, false);
  try {
    const DualProblem problem(column.decomposition, *column.directory, column.interface, column.constraints, column.floating,
                              column.load, {}, column.context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::no_equilibrium);
    EXPECT_NE(std::string(error.what()).find("body \"upper\" moves along (0, 0, -1)"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace mortise::feti
