// What is found once the multipliers are known: fields, checks, the summary, and the files.
#pragma once

#include "base/context.hpp"
#include "contact/state.hpp"
#include "io/summary.hpp"
#include "io/vtk.hpp"
#include "post/strength.hpp"
#include "post/verdict.hpp"
#include "simulation.hpp"

namespace mortise {

/// Fields and numbers of a solved problem.
struct Results {
  std::vector<Eigen::VectorXd> displacement;  ///< of each subdomain
  std::vector<Eigen::MatrixXd> nodal_stress;  ///< nodes x 6 of each subdomain, recovered inside the body
  /// Where bodies have several materials, of each subdomain: nodes x 6 blocks, the stress in each material; at nodes between two
  /// of them nodal_stress is that with the larger von Mises stress. And the block of each cell. Else empty.
  std::vector<Eigen::MatrixXd> material_stress;
  std::vector<std::vector<int>> cell_block;
  std::vector<Eigen::VectorXd> nodal_von_mises, cell_von_mises;
  std::vector<contact::PointState> points;      ///< of this rank's contact points
  std::vector<contact::Resultant> resultants;   ///< of each contact
  std::vector<contact::SurfaceState> surfaces;  ///< of each contact, its secondary side on this rank
  Point max_von_mises_at = Point::Zero();
  Point applied = Point::Zero(), reaction = Point::Zero();  ///< sums of loads and of support forces
  double rounding_of_force = 0, rounding_of_energy = 0;     ///< what rounding may leave of both where nothing is strained
  Point obstacles = Point::Zero();                          ///< sum of what rigid obstacles push the bodies with
  Point neighbours = Point::Zero();                         ///< sum of what the sectors beside a cyclic one pull with
  Point gauges = Point::Zero();  ///< what holds free motions against the push of facets, which is no force of the model
  double push_of_facets = 0;     ///< its size, relative to the largest force
  double largest_force = 0;      ///< of loads, supports, contacts
  post::MeshError mesh_error;    ///< where the estimated error is
  double imbalance = 0;          ///< of the sums of all these forces, relative to the largest one
  post::Verdict verdict;         ///< of this equilibrium
  io::Summary summary;
};

/// In the energy norm: the part of the error that is the mesh's, by recovered stresses [Zienkiewicz and Zhu, Int. J. Numer.
/// Methods Eng. 24 (1987)], inside each body, and the size of the solution.
struct EnergyNorms {
  double error = 0, solution = 0;
};
/// Collective.
EnergyNorms energy_norms(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                         const LoadState& state, const partition::Interface& interface,
                         const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

/// Whether it is solved, and what to say if not, stands in Results::verdict. Collective.
Results evaluate(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                 const Simulation& simulation, const Context& context);

/// The files of one state after the other: solution.pvd, contact.pvd and results.h5. With load steps each state has its own
/// pieces and tables, solution.1_0.vtu or results.1.h5, but for the last tables, which are results.h5.
class FieldFiles {
 public:
  FieldFiles(const Deck& deck, const partition::Decomposition& decomposition) : deck_(deck), decomposition_(decomposition) {}
  /// Collective.
  void write(const Simulation& simulation, const Results& results, double time, bool last, const Communicator& comm);

 private:
  const Deck& deck_;
  const partition::Decomposition& decomposition_;
  io::Series volume_{"solution", {}}, contact_{"contact", {}};
};

/// The lines on the terminal after a load step that is not the last.
void print_step(const Results& results, const Context& context);

/// The lines on the terminal at the end, for an engineer to judge, but for warnings. Collective.
void print(const Results& results, const Context& context);

}  // namespace mortise
