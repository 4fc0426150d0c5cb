// All that is known of an equilibrium once its multipliers are found.
#pragma once

#include "feti/dual_solution.hpp"
#include "post/balance.hpp"
#include "post/contact_checks.hpp"
#include "post/contact_results.hpp"
#include "post/extremes.hpp"
#include "post/interior.hpp"
#include "post/large_turns.hpp"
#include "post/nonconformity.hpp"
#include "post/strength.hpp"
#include "post/stress_recovery.hpp"
#include "post/verdict.hpp"

namespace mortise::post {

/// Of the bodies: what is drawn, sampled and tabulated.
struct Fields {
  double max_displacement = 0;
  StressField stress;
  Interior interior;              ///< see evaluate_interior()
  std::vector<Extreme> extremes;  ///< see find_extremes()
};

/// What holds the bodies and loads them, contacts aside.
struct Forces {
  std::vector<Reaction> reactions;       ///< of each support
  std::vector<CouplingState> couplings;  ///< of each coupling, by name
  std::vector<SpringState> springs;      ///< of each spring between points, by name
  Balance balance;
  std::vector<feti::UnresistedLoad> unresisted;  ///< see DualProblem::unresisted_loads()
  std::vector<double> shortenings;               ///< of each pretension section, given or found
};

/// How exactly all of it is known.
struct Accuracy {
  Residuals residuals;
  double algebraic_error = 0;                ///< of the solver, relative, in the energy norm; NaN: not estimated
  std::vector<ContactError> contact_errors;  ///< the part of the mesh's error that contacts have
  MeshError mesh_error;
};

/// What small displacements, and rows between sides that lie apart, leave out: for warnings alone.
struct Neglected {
  std::vector<ContactMoment> moments;  ///< of each contact; none in axisymmetry
  LargeTurn turn;
};

/// The parts by what takes them: field files and probes, contact files, the printed balance, warnings, the exit status; the
/// summary and the checks read all but a few.
struct Results {
  Fields fields;
  ContactResults contact;
  Forces forces;
  Accuracy accuracy;
  Neglected neglected;
  Verdict verdict;
};

/// Of all nodes of all subdomains, `dimension` components each. Collective.
double largest_displacement(const std::vector<Eigen::VectorXd>& displacement, int dimension, const Communicator& comm);

/// A solved equilibrium. `displacement`: of each subdomain; `tolerance`: the deck's, 0 where it is auto; `negligible`: an energy
/// norm that is nothing, see qp::Goal; `before`: the rounding of the states before, which is none in this one either;
/// `largest_force`: of them, see contact_results(); `slip_error`: the solver's errors in them, from which friction goes on, added
/// up, in the energy norm.
struct Equilibrium {
  const feti::DualProblem& problem;
  const feti::SubdomainSystem& system;
  std::span<const contact::Pair> pairs;
  const feti::DualSolution& solved;
  const std::vector<Eigen::VectorXd>& displacement;
  std::size_t supports = 0;
  double tolerance = 0;
  double negligible = 0;
  Rounding before;
  double largest_force = 0;
  double slip_error = 0;
};

/// Evaluates, and changes nothing. Whether it is solved, and what to say if not, stands in the verdict. Collective.
Results evaluate(const Equilibrium& e, const ElasticBodies& bodies, const Communicator& comm);

}  // namespace mortise::post
