// The solvers of quadratic programmes: what they have in common, and the table of them.
//
// A row of the table is a name in the deck, how its solver is made, and what it wants of its surroundings. What drives solvers
// (lib/analysis) asks for one by that name and knows no other difference between them than that some can follow a slip law by
// themselves.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "qp/budget.hpp"
#include "qp/options.hpp"
#include "qp/slip_law.hpp"
#include "qp/solution.hpp"

namespace mortise::qp {

/// A programme whose Hessian is at hand as a matrix.
struct ExplicitProgramme {
  struct Result {
    Vector x;
    Eigen::VectorXd nu;
    bool converged = false;  ///< exact to rounding; else the last guess, or one to begin with
    /// A x - b + G'nu by the matrix, zero where there is no constraint; there if go_on() can start from it.
    std::optional<Vector> reaction = {};
    bool settled = true;  ///< if it converged: no state of a constraint rests on rounding
    bool slides = false;  ///< if it did not converge: see Solution::slides
  };
  std::shared_ptr<ActiveSetPreconditioner> inverse;  ///< A^-1
  /// Solves in a set over the programme's unknowns; radii of discs with a coefficient follow their normal unknown. Collective.
  std::function<Result(const RightHandSide& right, const FeasibleSet& set)> solve;
  /// The same for b and e that differ from those of `right`, from the states of constraints at `near`: the solution of a problem
  /// before, if it converged, or states of this one that may be nearly right. Nothing else is tried. Empty if it cannot.
  /// Collective.
  std::function<Result(const RightHandSide& right, const Vector& b, const Eigen::VectorXd& e, const FeasibleSet& set,
                       const Result& near)>
      go_on = {};
  bool differs = false;  ///< whether the matrix differs from A by a little, so that go_on() has to correct solutions
  /// Other matrices, for where a solution with these does not converge or settle. Else empty. Collective.
  std::function<ExplicitProgramme()> instead = {};
  /// Whether products with A are rougher than these matrices, so that a solution is judged by its defect alone; and `inverse` is
  /// nearer to A^-1 than that of other matrices, so that it judges their solutions as well.
  bool rough_products = false;
  bool instead_of_none = false;  ///< `instead` is for where these find no solution: one that does not settle will do
};

/// What a solver may use besides the problem.
struct Means {
  Budget& budget;                                     ///< of products; says also whether another algorithm may take over
  ActiveSetPreconditioner* preconditioner = nullptr;  ///< if there is one
  /// Makes the matrices of a direct solution, for the solver that needs them. Collective.
  std::function<ExplicitProgramme()> make_explicit = {};
};

/// What a solver knows of solves that belong together before it goes on with them, for whoever drives it to pass on: nothing, but
/// where matrices were used.
struct Foreknown {
  /// The next solve's, which takes it: one that is judged, or forces by which bodies slide on (Solution::slides), which a slip
  /// law alone asks for.
  std::optional<Solution> answer = {};
  /// A solution by matrices that can be judged where a solve does not converge.
  std::optional<ExplicitProgramme::Result> by_matrices = {};
};

/// Solves a sequence of problems of one programme, one after the other; recycled directions stay. Refers to the programme's parts
/// and its means, which outlive it. A solution tells why it ended: converged; not feasible, proven or not; else the products ran
/// out, or nothing became better. `radii`: one for each disc of Programme::set.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Before the first of several solves that belong together (a load step), the last of them to `goal`: if the solver knows a
  /// better start than `start` it replaces that, and tells the goal how exact it is. `suggested`, which may be null, is what
  /// another way that gave up knows: x and the gradient by which constraints have their states. Collective.
  virtual Foreknown begin(const RightHandSide& /*right*/, std::span<const double> /*radii*/, std::optional<Solution>& /*start*/,
                          Goal& /*goal*/, const Observer& /*observer*/, const Solution* /*suggested*/ = nullptr)
  {
    return {};
  }
  /// The solution to `goal` with these radii, from `start`, or from a point of its own choice. `known`: from begin(), or null.
  /// Collective.
  virtual Solution solve(const RightHandSide& right, std::span<const double> radii, const std::optional<Solution>& start,
                         const Goal& goal, const Observer& observer, Foreknown* known = nullptr) = 0;
  /// The solution that fulfils the law, with radii found together with it: Solution::radii. Nothing where the solver needs radii
  /// that are given. Collective.
  virtual std::optional<Solution> solve(const RightHandSide& /*right*/, const SlipLaw& /*law*/,
                                        const std::optional<Solution>& /*start*/, const Goal& /*goal*/,
                                        const Observer& /*observer*/, Foreknown* /*known*/ = nullptr)
  {
    return {};
  }
  /// The best approximation of A^-1 that it has; may be null.
  virtual ActiveSetPreconditioner* preconditioner() = 0;
};

/// One row of the table. Its tolerances and limits, and where another row takes over, are the struct of its name in limits.hpp.
struct SolverKind {
  std::string_view name;  ///< in the deck
  std::string_view help;
  bool steady = false;  ///< its residual may rise for long: see Budget
  /// It compares products with matrices, so that whoever makes it has to make them exact before.
  bool exact_products = false;
  bool whole_bodies = false;   ///< it wants every body to be one subdomain
  bool two_residuals = false;  ///< the projected gradient and the equality's, which it drives down one after the other
  /// What `programme` and `means` refer to outlives the solver. Collective.
  std::unique_ptr<Solver> (*make)(const Programme& programme, const Means& means) = nullptr;
};

/// The table. To add a solver: a file with the function that makes it, and a row with its limits.
std::span<const SolverKind> solvers();

/// The row of a name in the deck; for `auto` the first one.
const SolverKind& solver_kind(std::string_view name);

/// The row of the solver of whole bodies.
const SolverKind& solver_of_whole_bodies();

}  // namespace mortise::qp
