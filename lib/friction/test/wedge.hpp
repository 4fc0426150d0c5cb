// A wedge whose states are known in closed form, and a load step of it with Coulomb friction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "feti/means.hpp"
#include "friction/coulomb.hpp"
#include "testing/blocks.hpp"

namespace mortise::friction {

// What each point of the wedge bears, with forces over its load. The wedge slides down by a length s as long as friction t up the
// walls and its normal force n leave something of its load, and that presses its sides together by a = s sin(slope):
//
//     n sin(slope) + t cos(slope) = 1,  k a = n cos(slope) - t sin(slope);
//
// friction along the walls bears the push. Where it sticks a = 0; where it slides friction is all of the slip bound r, so that
// t^2 = r^2 - push^2, and no bound below the push holds it.
struct WedgeForces {
  double slope, push, coefficient;  // degrees; a force; Coulomb's

  double sine() const { return std::sin(slope * M_PI / 180); }
  double cosine() const { return std::cos(slope * M_PI / 180); }
  double up(double bound) const { return std::min(cosine(), std::sqrt(bound * bound - push * push)); }
  double normal(double bound) const { return (1 - cosine() * up(bound)) / sine(); }
  // The bound that Coulomb's law asks for at the forces with this one.
  double next(double bound) const { return coefficient * normal(bound); }
  // Its fixed point, with the root t of (t^2 + push^2) sin^2 = coefficient^2 (1 - t cos)^2 that leaves a normal force.
  double bound() const
  {
    const double c = cosine(), squares = coefficient * coefficient, a = sine() * sine() - squares * c * c, b = squares * c,
                 rest = push * push * sine() * sine() - squares;
    return std::hypot((-b + std::sqrt(b * b - a * rest)) / a, push);
  }
  // More does not stay, whatever the walls press: there n sin = 1.
  static double greatest_push(double slope, double coefficient) { return coefficient / std::sin(slope * M_PI / 180); }
};

// The corners of a cube of which every deformation costs the same, K = k (I - R R') with its rigid motions R. The sides x = 0 and
// x = 1 are held by walls that lean by `slope` degrees against z; each corner is loaded by 1 along -z and by `push` along y.
struct Wedge : feti::Blocks {
  static constexpr double stiffness = 100;
  static constexpr std::size_t count = 8;
  std::vector<Global> points;               // of both sides; point i stands on rank i % ranks
  std::vector<std::array<Point, 3>> frame;  // normal out of the wedge, and tangents: along y, and up

  Wedge(double slope, double push)
      : Blocks({{"wedge", {{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, "hex8"}}}, {{"wedge", {1, 1, 1}}}, [](int) { return stiffness; })
  {
    feti::Subdomains subdomains;
    system.nodal_stiffness.clear();
    for (std::size_t s = 0; s < load.size(); ++s) {
      const auto& mesh = decomposition.subdomains[s].mesh;
      const Eigen::MatrixXd r = fem::rigid_motions(mesh.points, fem::Kinematics::solid);
      const Eigen::MatrixXd k = stiffness * (Eigen::MatrixXd::Identity(r.rows(), r.rows()) - r * r.transpose());
      const Eigen::MatrixXd lower = k.triangularView<Eigen::Lower>();
      subdomains.push_back(std::make_shared<feti::ElasticSubdomain>(lower.sparseView(), r, mesh.points, 3, "cholmod"));
      system.nodal_stiffness.push_back(feti::nodal_stiffness(k.diagonal(), 3));
      for (std::size_t n = 0; n < mesh.points.size(); ++n)
        load[s].segment(3 * static_cast<Eigen::Index>(n), 3) = Point(0, push, -1);
    }
    system.clusters = feti::Clusters(decomposition, interface, subdomains, system.nodal_stiffness, fem::Kinematics::solid);
    for (const bool left : {true, false}) {
      auto ids = comm.all_gather(side(left ? "wedge.xmin" : "wedge.xmax").node_id);
      std::sort(ids.begin(), ids.end());
      ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
      points.insert(points.end(), ids.begin(), ids.end());
      const double angle = slope * M_PI / 180, out = left ? -1 : 1;
      frame.resize(points.size(), {Point(out * std::cos(angle), 0, -std::sin(angle)), Point(0, 1, 0),
                                   Point(out * std::sin(angle), 0, std::cos(angle))});
    }
    auto& contacts = constraints.contacts;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (static_cast<int>(i) % comm.size() != comm.rank()) continue;
      contacts.nodes.push_back({0, points[i], 1, frame[i][0], {frame[i][1], frame[i][2]}, contacts.rows.size()});
      contacts.bonded.push_back(false);
      for (const Point& axis : frame[i]) {
        for (int c = 0; c < 3; ++c)
          if (axis[c] != 0) contacts.rows.entries.push_back({points[i], c, axis[c]});
        contacts.rows.close(0);
      }
    }
  }
};

// What drives one load step, to a residual. Collective.
struct CoulombStep {
  // `product`: with F, or nearly.
  CoulombStep(const feti::DualProblem& dual, const Operator& product, double coefficient, const std::string& algorithm,
              double tolerance)
      : problem(dual),
        laws{{Law::Kind::coulomb, coefficient}},
        hessian(product, 0),
        budget(hessian, {}, qp::solver_kind(algorithm).steady),
        omega(with_coefficients(dual.system(), laws)),
        solver(qp::solver_kind(algorithm).make({hessian, dual.equality(), omega},
                                               feti::means_of(dual.system(), preconditioner.get(), budget))),
        right(dual.right_hand_side()),
        goal{tolerance},
        options{tolerance, 100}
  {
  }
  CoulombStep(const feti::DualProblem& dual, double coefficient, const std::string& algorithm, double tolerance)
      : CoulombStep(dual, dual.hessian(), coefficient, algorithm, tolerance)
  {
  }
  // By all ways that there are.
  feti::DualSolution solve()
  {
    std::optional<qp::Solution> start;
    auto known = solver->begin(*right, problem.radii(slip_bounds(problem, laws, nullptr)), start, goal, {});
    return solve_coulomb({problem, laws, omega, *right, goal, options, start, start}, {*solver, hessian, budget, &known}, {},
                         [this](int number, double, const qp::Progress& progress) { watch(number, progress); })
        .found;
  }

  const feti::DualProblem& problem;
  std::vector<Law> laws;
  std::unique_ptr<qp::ActiveSetPreconditioner> preconditioner = problem.system().make_preconditioner();
  qp::Hessian hessian;
  qp::Budget budget;
  qp::FeasibleSet omega;
  std::unique_ptr<qp::Solver> solver;
  std::shared_ptr<const qp::RightHandSide> right;
  qp::Goal goal;
  Options options;
  std::function<void(int step, const qp::Progress& progress)> watch = [](int, const qp::Progress&) {};
};

}  // namespace mortise::friction
