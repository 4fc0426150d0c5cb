// A wedge between two walls, and a load step of it with Coulomb friction.
#pragma once

#include <cmath>

#include "feti/means.hpp"
#include "friction/coulomb.hpp"
#include "testing/blocks.hpp"

namespace mortise::friction {

// A cube whose sides x = 0 and x = 1 are held by walls that lean by `slope` degrees against z; loaded by 1 along -z and by `push`
// along y, all over.
struct Wedge : feti::Blocks {
  std::vector<Global> points;               // the nodes of both sides
  std::vector<std::array<Point, 3>> frame;  // normal out of the wedge, and tangents

  Wedge(double slope, double push, int pieces, MPI_Comm mpi = MPI_COMM_WORLD)
      : Blocks(
            {{"wedge", {{0, 0, 0}, {1, 1, 1}, {2, 3, 3}, "hex8"}}}, {{"wedge", {1, 1, pieces}}}, [](int) { return 100.0; }, mpi)
  {
    for (std::size_t s = 0; s < load.size(); ++s)
      fem::add_acceleration(decomposition.subdomains[s].mesh, fem::Kinematics::solid, 1.0, Point(0, push, -1), load[s]);
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
  CoulombStep(const feti::DualProblem& dual, double coefficient, const std::string& algorithm, double tolerance)
      : problem(dual),
        laws{{Law::Kind::coulomb, coefficient}},
        budget(hessian, {}, qp::solver_kind(algorithm).steady),
        omega(with_coefficients(dual.system(), laws)),
        solver(qp::solver_kind(algorithm).make({hessian, dual.equality(), omega},
                                               feti::means_of(dual.system(), preconditioner.get(), budget))),
        right(dual.right_hand_side()),
        goal{tolerance}
  {
  }
  // By all ways that there are.
  feti::DualSolution solve()
  {
    std::optional<qp::Solution> start;
    solver->begin(*right, problem.radii(slip_bounds(problem, laws, nullptr)), start, goal, {});
    return solve_coulomb({problem, laws, omega, *right, goal, {goal.residual, 200}, start, start}, {*solver, hessian, budget}, {},
                         [this](int number, double, const qp::Progress& progress) { watch(number, progress); })
        .found;
  }

  const feti::DualProblem& problem;
  std::vector<Law> laws;
  std::unique_ptr<qp::ActiveSetPreconditioner> preconditioner = problem.system().make_preconditioner();
  qp::Hessian hessian{problem.hessian(), 0};
  qp::Budget budget;
  qp::FeasibleSet omega;
  std::unique_ptr<qp::Solver> solver;
  std::shared_ptr<const qp::RightHandSide> right;
  qp::Goal goal;
  std::function<void(int step, const qp::Progress& progress)> watch = [](int, const qp::Progress&) {};
};

}  // namespace mortise::friction
