// Friction: where the slip bounds of the contact nodes come from, and the fixed point that Coulomb's law needs.
//
// Tresca: the bound of a point is a given traction times its area; one quadratic programme gives the answer. Coulomb: the bound
// is the coefficient times the point's normal force, which is found by repeating Tresca problems, each solved only as exactly as
// the bounds are known and started from the one before. A solver that can follow a slip law by itself (qp::SlipLaw) is asked for
// bounds and forces together first; the fixed point goes on where that does not converge. The first step lets every Coulomb point
// stick, so that a floating body that is pushed sideways has an equilibrium from the start; a later load step begins with the
// bounds that the one before ended with.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "feti/dual_problem.hpp"
#include "friction/law.hpp"
#include "friction/options.hpp"
#include "friction/unresolved_nodes.hpp"
#include "qp/options.hpp"
#include "qp/solver.hpp"

namespace mortise::friction {

/// The multipliers of one load step, and what it took to find them.
struct Result {
  qp::Solution solution;
  std::vector<double> slip_bounds = {};  ///< of each disc of problem.set(), forces: infinite where it sticks
  int steps = 1;      ///< Tresca problems solved
  double change = 0;  ///< relative, of the slip bounds in the last step
  bool converged = false;
  std::string limit = {};                 ///< the key of the deck that ended it early, if one did, and a remark
  bool gave_up = false;                   ///< patience ended first: another approach is to go on
  int applications = 0;                   ///< products with F, of this load step
  int preconditionings = 0;               ///< of this load step
  int outer_iterations = 0;               ///< of all Tresca problems
  std::vector<Undecided> undecided = {};  ///< points whose state is not known
  std::vector<Stuck> stuck = {};          ///< where it made no progress, if it did not converge
};

/// One line of progress: the number of the Tresca problem, the relative change of the slip bounds before it, and where the solver
/// stands.
using Observer = std::function<void(int step, double change, const qp::Progress&)>;

/// What errors are compared with, at the multipliers lambda and nu: the functions of qp::Goal with the same names. Collective.
struct Accuracy {
  using Measure = std::function<double(const Vector& lambda, const Eigen::VectorXd& nu)>;
  Measure allowed_error;         ///< the algebraic error that is good enough, in the energy norm
  Measure expected_allowed_error;  ///< about the same, with multipliers that the last product was with
  Measure energy_norm;           ///< of the displacements
  Measure incompatibility = {};  ///< how far displacements of subdomains do not fit together, over the largest of them
  double negligible = 0;         ///< see qp::Goal
};

/// A sequence of load steps on one dual problem, which may get other right-hand sides between them: recycled directions stay.
class Solver {
 public:
  /// The problem outlives it. laws[c]: of contact c. Collective.
  Solver(feti::DualProblem& problem, std::vector<Law> laws, const Options& options, const qp::Options& solver);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Solves for the multipliers, to the tolerance of the solver's options or, where that is auto, to the allowed error; from
  /// `start`, the solution of the step before, if there is one. `patience`: when it gives up in favour of another approach; with
  /// one, it also gives up where its algorithm makes no more progress. Throws Error(no_equilibrium) that names the body that
  /// moves and how. Collective.
  Result solve(const qp::Solution* start, const Accuracy& accuracy, const Observer& observer,
               std::optional<qp::Patience> patience = {});
  /// Products with F of all solves, also of one that threw.
  int applications() const { return hessian_.count(); }

 private:
  struct Run;
  Run begin(const qp::Solution* start, const Accuracy& accuracy, std::optional<qp::Patience> patience);
  std::vector<double> radii_at(const Vector* lambda) const;
  void follow_law(Run& run);
  void follow_cautiously(const qp::Solution* start, Run& run);
  bool obeys_law(const qp::Solution& found, const std::vector<double>& bounds, double change, const Run& run) const;
  bool solve_tresca(const qp::Goal& goal, Run& run);
  bool contacts_at_rest(const Run& run);
  bool at_rest(const std::vector<double>& wanted, double tolerance, Run& run);
  double error_of_bounds(const std::vector<double>& wanted, const Run& run);
  void note_response(const std::vector<double>& wanted, Run& run) const;
  double change_of_bounds(const std::vector<double>& wanted, const std::vector<double>& now, const qp::Solution& at,
                          const Run& run) const;
  void admit(Run& run);
  void fixed_point(Run& run);
  void note(Run& run, const qp::Progress& progress);
  void report_unresolved_nodes(const Run& run, Result& result);

  feti::DualProblem& problem_;
  std::vector<Law> laws_;
  Options options_;
  std::optional<double> tolerance_;  // of the residual; without one the error decides
  bool from_direct_;  // a direct solution is where all begins
  qp::Hessian hessian_;
  qp::Budget budget_;
  const qp::FeasibleSet omega_;  // with the coefficients of the laws; radii are those of a run
  std::unique_ptr<qp::Solver> algorithm_;
};

}  // namespace mortise::friction
