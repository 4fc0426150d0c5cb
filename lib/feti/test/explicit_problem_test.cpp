// A block that floats on another: the dual operator as a matrix against products with it, and the direct solution against face
// Newton's.
#include "feti/explicit_problem.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "constraint/preload.hpp"
#include "constraint/supports.hpp"
#include "fem/loads.hpp"
#include "fem/stiffness.hpp"
#include "feti/placement.hpp"
#include "partition/decompose.hpp"
#include "qp/face_newton.hpp"

namespace mortise::feti {
namespace {

constexpr double coefficient = 0.4;

// What a stack has beside the supports below.
struct Variant {
  bool upper_held = false;      // along x on top, where there is a preload along all axes
  bool inclined = false;        // at nodes of the lower block that are held along another axis, too
  bool turned = false;          // the operator of the upper block is that of a turned copy
  double moved = 0;             // along x, by all supports
  std::optional<double> force;  // of a preload: the blocks are bonded and drawn together
};

// Held at z = 0; pressed down and pushed sideways on top, where the upper block stands on the nodes of the lower one.
struct Stack {
  Communicator comm;
  Timers timers;
  Log log{comm, nullptr};
  Context context{comm, log, timers};
  partition::Decomposition decomposition;
  std::unique_ptr<partition::NodeDirectory> directory;
  partition::Interface interface;
  Floating floating;
  constraint::Constraints constraints;

  Stack(const Point& traction, int pieces, const Variant& variant = {}) : comm(MPI_COMM_WORLD)
  {
    mesh::Options mesh;
    mesh.blocks["lower"] = {{0, 0, 0}, {1, 1, 1}, {3, 3, 2}, "hex8"};
    mesh.blocks["upper"] = {{0, 0, 1}, {1, 1, 2}, {3, 3, 4}, "hex8"};
    partition::Options options;
    options.method = "grid";
    options.counts["lower"] = {1, 1, 1};
    options.counts["upper"] = {1, 1, pieces};
    decomposition = partition::decompose(mesh, options, 3, context);
    Subdomains subdomains;
    const auto load_on = boundary("upper.zmax");
    for (const auto& s : decomposition.subdomains) {
      const bool turned = variant.turned && s.body == 1;
      const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()).toRotationMatrix();
      auto original = s.mesh;
      if (turned)
        for (auto& point : original.points) point = rotation.transpose() * point;
      auto stiffness = fem::stiffness(original, fem::Material{1000, 0.3, 0, 0}, fem::Kinematics::solid);
      floating.nodal_stiffness.push_back(nodal_stiffness(stiffness, 3));
      floating.load.emplace_back(Eigen::VectorXd::Zero(stiffness.cols()));
      fem::add_traction(s.mesh, load_on, fem::Kinematics::solid, traction, floating.load.back());
      subdomains.push_back(std::make_shared<ElasticSubdomain>(
          std::move(stiffness), fem::rigid_motions(original.points, fem::Kinematics::solid), original.points, 3, "cholmod"));
      if (turned) subdomains.back() = std::make_shared<TurnedSubdomain>(subdomains.back(), rotation, 3);
    }
    directory = std::make_unique<partition::NodeDirectory>(decomposition, floating.nodal_stiffness, comm);
    interface = partition::find_interface(decomposition, *directory, comm);
    floating.clusters = Clusters(decomposition, interface, subdomains, floating.nodal_stiffness, fem::Kinematics::solid);
    std::vector<constraint::SupportOptions> supports{{"lower.zmin", {variant.moved, 0, 0}}};
    std::vector<std::vector<Global>> nodes{side("lower.zmin").node_id};
    if (variant.upper_held) {
      const std::optional<double> others = variant.force ? std::optional(0.0) : std::nullopt;
      supports.push_back({"upper.zmax", {variant.moved, others, others}});
      nodes.push_back(side("upper.zmax").node_id);
    }
    constraints.held = constraint::hold(supports, nodes, 3, comm);
    if (variant.inclined) incline();
    touch(variant.force.has_value());
    if (variant.force)
      constraints.cuts =
          constraint::find_cuts(constraints.contacts, std::vector{constraint::Preload{0, "cut", variant.force}}, false, comm);
    constraints.held = place(constraints.held, decomposition, *directory, comm);
    constraints.inclined = place(constraints.inclined, decomposition, *directory, comm);
  }

  // The lower block's nodes at x = z = 0 are held along y, and along a direction between x and z instead of these.
  void incline()
  {
    std::vector<Global> edge;
    for (const auto& node : nodes_of("lower.zmin"))
      if (node.x < 0.1) edge.push_back(node.id);
    std::vector<constraint::Held> left;
    for (const auto& held : constraints.held) {
      if (held.component == 1 || std::find(edge.begin(), edge.end(), held.node) == edge.end())
        left.push_back(held);
      else if (held.component == 0)
        constraints.inclined.push_back({held.node, {0.6, 0, 0.8}, 0.01, {}, 0});
    }
    constraints.held = std::move(left);
  }

  int boundary(const std::string& name) const
  {
    const auto& names = decomposition.catalogue.boundaries;
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  }
  mesh::Surface side(const std::string& name) const
  {
    return partition::boundary_surface(decomposition, boundary(name), {true, true});
  }

  struct Node {
    double x, y;
    Global id;
  };
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

  // Node by node; rows stand on the ranks in turn.
  void touch(bool bonded)
  {
    const auto above = nodes_of("upper.zmin"), below = nodes_of("lower.zmax");
    auto& contacts = constraints.contacts;
    for (std::size_t i = 0; i < above.size(); ++i) {
      if (static_cast<int>(i) % comm.size() != comm.rank()) continue;
      const std::vector<Point> frame{Point(0, 0, -1), Point(0.6, 0.8, 0), Point(0.8, -0.6, 0)};
      contacts.points.push_back({0, above[i].id, 1, frame[0], {frame[1], frame[2]}, contacts.rows.size()});
      contacts.bonded.push_back(bonded);
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

// The whole of it on every rank, by products with the unit vectors, nothing eliminated.
struct Dense {
  Eigen::MatrixXd f, g;
  Eigen::VectorXd d;
  qp::FeasibleSet set;
  const Communicator& comm;
  const Map& rows;

  explicit Dense(const DualProblem& problem) : comm(problem.communicator()), rows(*problem.jump().rows())
  {
    const auto size = static_cast<Eigen::Index>(problem.dual_unknowns());
    f.resize(size, size);
    const auto& part = problem.equality().local();
    g = Eigen::MatrixXd::Zero(part.rows(), size);
    for (Local i = 0; i < part.cols(); ++i) g.col(number(i)) = part.col(i);
    comm.sum_in_place({g.data(), static_cast<std::size_t>(g.size())});
    d = whole(problem.linear());
    for (Eigen::Index j = 0; j < size; ++j) {
      Vector unit(problem.jump().rows()), product(problem.jump().rows());
      if (const Local i = rows.getLocalElement(j); i != Teuchos::OrdinalTraits<Local>::invalid()) view(unit)[i] = 1;
      problem.hessian().apply(unit, product);
      f.col(j) = whole(product);
    }
    struct Point {
      Local normal, first, second;
    };
    std::vector<Point> points;
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
                                                          Variant{false, true, true}, Variant{true, false, false, 0.01, 3.0})));

TEST_P(Varied, HasTheInverseOfTheDualOperator)
{
  const auto& [pieces, variant] = GetParam();
  const Stack stack(Point(1, 0.5, -10), pieces, variant);
  DualProblem problem(stack.decomposition, *stack.directory, stack.interface, stack.constraints, stack.floating, {},
                      stack.context);
  ExplicitProblem direct(problem, 0);
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

TEST_P(Varied, SolvesAsWithoutElimination)
{
  const auto& [pieces, variant] = GetParam();
  const Stack stack(Point(1, 0.5, -10), pieces, variant);
  DualProblem problem(stack.decomposition, *stack.directory, stack.interface, stack.constraints, stack.floating, {},
                      stack.context);
  auto& set = problem.set();
  set.set_coefficients(std::vector<double>(set.discs().size(), coefficient));
  set.set_radii(std::vector<double>(set.discs().size(), std::numeric_limits<double>::infinity()));
  const auto found = ExplicitProblem(problem, 0).solve();
  ASSERT_TRUE(found.settled);

  const Dense dense(problem);
  const auto motions = dense.g.rows();
  const auto expected = qp::CondensedNewton(dense.f, dense.g, Eigen::MatrixXd::Zero(motions, motions), dense.set)
                            .solve(dense.d, problem.equality().right_side(), dense.set);
  ASSERT_TRUE(expected.settled);
  EXPECT_GT(expected.x.norm(), 0.1);
  EXPECT_LT((dense.whole(found.x) - expected.x).norm(), 1e-9 * expected.x.norm());
  EXPECT_LT((found.nu - expected.nu).norm(), 1e-9 * expected.nu.norm());
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
