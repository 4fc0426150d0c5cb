// Blocks of section 1 x 2 on each other, each cut in two, and their equilibria: states of uniform stress, which hexahedra have
// exactly, so that statics and Hooke's law say all there is to know.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "contact/mortar.hpp"
#include "feti/dual_solution.hpp"
#include "feti/means.hpp"
#include "feti/row_distribution.hpp"
#include "testing/blocks.hpp"

namespace mortise::post {

struct Pieces : feti::Blocks {
  static constexpr double young = 1000, poisson = 0.3;
  static constexpr double area = 2;  // of the section
  inline static const Point centre = Point(1.5, 1.5, 0);

  // The lower one stands on z = 0 and ends at z = 1, the upper one begins there or `apart` above, and is 1 high as well.
  explicit Pieces(bool upper = true, double apart = 0)
      : Blocks(
            upper ? std::map<std::string, mesh::BlockOptions>{{"lower", block(0)}, {"upper", block(1 + apart)}}
                  : std::map<std::string, mesh::BlockOptions>{{"lower", block(0)}},
            upper ? std::vector<Counts>{{"lower", {1, 2, 1}}, {"upper", {1, 1, 2}}} : std::vector<Counts>{{"lower", {1, 2, 1}}},
            [](int) { return young; })
  {
  }
  static mesh::BlockOptions block(double z) { return {{1, 0.5, z}, {1, 2, 1}, {2, 4, 2}, "hex8"}; }

  // What slides along x = 1 and y = 0.5, and stands on z = 0, as its own support each: of pressures a uniform stress comes.
  void guide(bool upper = true)
  {
    std::vector<constraint::Support> supports{{"lower.zmin", {std::nullopt, std::nullopt, 0.0}}};
    for (const std::string body : {"lower", "upper"}) {
      if (body == "upper" && !upper) continue;
      supports.push_back({body + ".xmin", {0.0, std::nullopt, std::nullopt}});
      supports.push_back({body + ".ymin", {std::nullopt, 0.0, std::nullopt}});
    }
    dirichlet_rows(supports);
  }
  // A contact between the two, with mortar rows.
  std::vector<contact::Pair> touch(contact::Law law = contact::Law::frictionless, double search_distance = 0)
  {
    std::vector<contact::Pair> pairs(1);
    pairs[0].options.name = "joint";
    pairs[0].options.secondary = "upper.zmin";
    pairs[0].options.primary = "lower.zmax";
    pairs[0].options.law = law;
    pairs[0].options.search_distance = search_distance;
    pairs[0].secondary = side("upper.zmin");
    pairs[0].primary = std::make_shared<const mesh::Surface>(side("lower.zmax"));
    constraints.contacts = contact::discretize(pairs, constraints.prescribed, fem::Kinematics::solid, comm);
    return pairs;
  }

  // Rows of supports on ranks that have their nodes.
  constraint::Constraints placed() const
  {
    auto result = constraints;
    result.prescribed = feti::distribute_rows(std::span(std::as_const(result.prescribed)), decomposition, *directory, comm);
    result.skew_supports = feti::distribute_rows(std::span(std::as_const(result.skew_supports)), decomposition, *directory, comm);
    result.springs.own = feti::rows_here(result.springs.rows, decomposition, *directory, comm);
    return result;
  }
  feti::DualProblem problem() const
  {
    return {decomposition, *directory, interface, std::make_shared<const constraint::Constraints>(placed()),
            system,        load,       {},        context};
  }

  // u(x) at all nodes; `only`: of one subdomain, all others stay.
  template <class Field>
  std::vector<Eigen::VectorXd> displacement(const Field& u, Global only = -1) const
  {
    std::vector<Eigen::VectorXd> result;
    for (const auto& s : decomposition.subdomains) {
      auto& own = result.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(s.mesh.node_count()) * 3));
      if (only >= 0 && s.id != only) continue;
      for (std::size_t n = 0; n < s.mesh.node_count(); ++n)
        own.segment<3>(3 * static_cast<Eigen::Index>(n)) = Point(u(s.mesh.points[n], s.body));
    }
    return result;
  }

  // How much of the section a node of it stands for.
  static double share(const Point& x)
  {
    const auto part = [](double at, double low, double high) {
      return std::abs(at - low) < 1e-9 || std::abs(at - high) < 1e-9 ? 0.25 : 0.5;
    };
    return part(x[0], 1, 2) * part(x[1], 0.5, 2.5);
  }
  // Places of the nodes of a section, in the order of nodes_of().
  std::vector<std::pair<Global, Point>> section(const std::string& name, double z) const
  {
    std::vector<std::pair<Global, Point>> result;
    for (const auto& node : nodes_of(name)) result.emplace_back(node.id, Point(node.x, node.y, z));
    return result;
  }
  bool mine(std::size_t i) const { return static_cast<int>(i) % comm.size() == comm.rank(); }
};

// An equilibrium without friction, to rounding. Collective.
inline feti::DualSolution solved(const feti::DualProblem& problem)
{
  qp::Hessian hessian(problem.hessian(), 0);
  qp::Budget budget(hessian, {}, false);
  const std::vector<double> radii(problem.set().discs().size(), 0.0);
  const auto preconditioner = problem.system().make_preconditioner();
  const auto solver =
      qp::solver_kind("face_newton")
          .make({hessian, problem.equality(), problem.set()}, feti::means_of(problem.system(), preconditioner.get(), budget));
  const auto right = problem.driven_right_hand_side(hessian);
  feti::DualSolution result{solver->solve(*right, radii, {}, {1e-12}, {})};
  result.slip_bounds = problem.slip_bounds(problem.set().with_radii(radii));
  result.converged = result.solution.converged;
  EXPECT_TRUE(result.converged);
  return result;
}

inline void expect_near(const std::array<double, 3>& found, const Point& exact, double tolerance = 1e-8)
{
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[static_cast<std::size_t>(c)], exact[c], tolerance) << c;
}
inline Point vector(const std::array<double, 3>& v)
{
  return {v[0], v[1], v[2]};
}

}  // namespace mortise::post
