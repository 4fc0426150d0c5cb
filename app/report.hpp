// What is found once the multipliers are known: fields, checks, the summary, and the files.
#pragma once

#include "base/context.hpp"
#include "contact/state.hpp"
#include "io/summary.hpp"
#include "model.hpp"

namespace mortise {

/// Fields and numbers of a solved problem.
struct Results {
  std::vector<Eigen::VectorXd> displacement;  ///< of each subdomain
  std::vector<Eigen::MatrixXd> nodal_stress;  ///< nodes x 6 of each subdomain, recovered inside the body
  std::vector<Eigen::VectorXd> nodal_von_mises, cell_von_mises;
  std::vector<contact::PointState> points;      ///< of this rank's contact points
  std::vector<contact::Resultant> resultants;   ///< of each contact
  std::vector<contact::SurfaceState> surfaces;  ///< of each contact, its secondary side on this rank
  Point max_von_mises_at = Point::Zero();
  Point applied = Point::Zero(), reaction = Point::Zero();  ///< sums of loads and of support forces
  double rounding_of_force = 0, rounding_of_energy = 0;     ///< what rounding may leave of both where nothing is strained
  double imbalance = 0;  ///< of the sums of loads and support forces, relative to the largest force
  std::string limit;     ///< the key that ended the solver early, or ""
  io::Summary summary;
};

/// The part of the error that is the mesh's, in the energy norm, by recovered stresses [Zienkiewicz and Zhu, Int. J. Numer.
/// Methods Eng. 24 (1987)], inside each body. Collective.
double discretization_error(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                            const partition::Interface& interface, const std::vector<Eigen::VectorXd>& displacement,
                            const Communicator& comm);

/// Collective.
Results evaluate(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                 const partition::Interface& interface, const std::vector<contact::Pair>& pairs, const feti::DualProblem& problem,
                 const feti::Floating& floating, const friction::Result& solved, const Context& context);

/// Writes every file but the history and the summary. Collective.
void write_fields(const Deck& deck, const partition::Decomposition& decomposition, const std::vector<contact::Pair>& pairs,
                  const partition::Interface& interface, const feti::DualProblem& problem, const friction::Result& solved,
                  const Results& results, const Communicator& comm);

/// The last lines on the terminal, for an engineer to judge. Collective.
void print(const Results& results, const Context& context);

}  // namespace mortise
