// Forces on the bodies: what loads, supports, obstacles and neighbours push them with, and whether it adds up.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "contact/mortar.hpp"
#include "contact/state.hpp"
#include "feti/dual_problem.hpp"
#include "partition/node_directory.hpp"

namespace mortise::post {

/// What a support does to the bodies: its resultant, and its moment about the origin.
struct Reaction {
  std::array<double, 3> force{}, moment{};
  bool operator==(const Reaction& other) const = default;
};

/// The reaction of each of the deck's `supports`, so many; contact forces that go straight into them count, what the axis of
/// revolution holds does not. Collective.
std::vector<Reaction> reactions(const feti::DualProblem& problem, const Vector& lambda, std::size_t supports);

/// Of each subdomain, nodes x 3: the forces that hold the nodes of supports, along the components that these hold; the same at
/// all copies of a node. Where a contact pushes such a node, it is the force of support and contact together. Rows of supports
/// stand on ranks that have their nodes, see feti::distribute_rows(). Collective.
std::vector<Eigen::MatrixXd> holding_forces(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                                            const partition::Interface& interface, const Vector& lambda);

/// The point of a coupling. Of six numbers the first three are displacements or forces, the others angles or moments about the
/// point.
struct CouplingState {
  std::array<double, 6> motion{};    ///< of the point
  std::array<double, 6> action{};    ///< on the boundary: the loads at the point and the reaction
  std::array<double, 6> reaction{};  ///< of the supports that hold the point
};
/// Of all couplings, by name, but for the motions, which stay 0. Collective.
std::vector<CouplingState> coupling_states(const feti::DualProblem& problem, const Vector& lambda);

/// A spring between two points: its force, > 0 if it pulls them together, and its elongation, a length.
struct SpringState {
  double force = 0, elongation = 0;
};
/// Of all springs, by name. Collective.
std::vector<SpringState> spring_states(const feti::DualProblem& problem, const Vector& lambda);

/// Sums of forces; in axisymmetry those along the axis alone, since what pushes a ring outwards needs no support.
struct Balance {
  Point applied = Point::Zero(), supports = Point::Zero();
  Point obstacles = Point::Zero();   ///< rigid ones
  Point neighbours = Point::Zero();  ///< the sectors beside a cyclic one
  Point gauges = Point::Zero();      ///< what holds free motions against the push of facets, which is no force of the model
  double largest = 0;                ///< force: of loads, supports, contacts
  double acting = 0;                 ///< the same, but at least a part of what presses in contacts before it cancels, as in a fit
  double difference = 0;             ///< of the sum of all, relative to the largest
  double push_of_facets = 0;         ///< of `gauges`, relative to `acting`
};

/// What rounding, and a solver that is measured by the loads, may leave where nothing is strained.
struct Rounding {
  double force = 0, energy = 0;
  double length = 0,  ///< of distances that are to be none, beside displacements and what loads do that go straight into supports
      work = 0;       ///< the work of these loads
  double moved = 0;   ///< of energies, where errors are measured by displacements: grows with rigid motions
  /// Keeps the larger of each but the work, which is that of this state's loads alone.
  void take(const Rounding& other);
};
/// Of displacements and nodal forces of each subdomain (loads that go straight into supports among them); `size`: of the model, a
/// length. Collective.
Rounding rounding(const std::vector<Eigen::VectorXd>& displacement, const std::vector<Eigen::VectorXd>& load,
                  const std::vector<std::vector<double>>& nodal_stiffness, int dimension, double size, const Communicator& comm);

/// The balance of forces of a solution. `reactions`, `contacts` and `couplings`: of each support, contact and coupling.
/// Collective.
Balance balance(const feti::DualProblem& problem, const Vector& lambda, std::span<const Reaction> reactions,
                std::span<const contact::Resultant> contacts, std::span<const contact::Pair> pairs, bool axisymmetric,
                std::span<const CouplingState> couplings, const Rounding& rounding);

}  // namespace mortise::post
