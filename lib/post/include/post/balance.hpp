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

/// Of each of the deck's supports; contact forces that go straight into them count. Axes of revolution are none of them.
/// Collective.
std::vector<Reaction> reactions(const feti::DualProblem& problem, const Vector& lambda, std::size_t supports);

/// Of each subdomain, nodes x 3: what holds the nodes that supports hold, along the components that they hold; at all copies of a
/// node the same. Where a contact pushes such a node, it is the force of support and contact together. Collective.
std::vector<Eigen::MatrixXd> holding_forces(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                                            const partition::Interface& interface, const Vector& lambda);

/// Of a coupling: how its point moves and turns, and what it does to the boundary, forces and then moments about the point: the
/// loads at the point and the reaction of the supports that hold it.
struct CouplingState {
  std::array<double, 6> motion{}, action{}, reaction{};
};
/// All but the motions. Collective.
std::vector<CouplingState> coupling_states(const feti::DualProblem& problem, const Vector& lambda);

/// Of a spring between two points: its force, > 0 if it pulls them together, and its elongation.
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
  double largest = 0;                ///< of loads, supports, contacts
  double acting = 0;                 ///< the same, at least a part of what presses in contacts before it cancels, as in a fit
  double difference = 0;             ///< of the sum of all, relative to the largest
  double push_of_facets = 0;         ///< of `gauges`, relative to `acting`
};

/// What rounding, and a solver whose measure are the loads, may leave where nothing is strained: of forces and of energies; and
/// of the overlaps that loads press with which go straight into what holds them, and their work. `moved`: of energies as well,
/// where a solver's errors are measured by displacements, as those of a lifted body; they grow with rigid motions.
struct Rounding {
  double force = 0, energy = 0, length = 0, work = 0, moved = 0;
  /// What is rounding here or there; but for the work, which a state of smaller loads has to fit to.
  void take(const Rounding& other);
};
/// For displacements of each subdomain and the forces that act on its nodes, those of loads that go straight into supports among
/// them; `size` is that of the model. Collective.
Rounding rounding(const std::vector<Eigen::VectorXd>& displacement, const std::vector<Eigen::VectorXd>& load,
                  const std::vector<std::vector<double>>& nodal_stiffness, int dimension, double size, const Communicator& comm);

/// `reactions`, `contacts` and `couplings`: of each support, contact and coupling. Collective.
Balance balance(const feti::DualProblem& problem, const Vector& lambda, std::span<const Reaction> reactions,
                std::span<const contact::Resultant> contacts, std::span<const contact::Pair> pairs, bool axisymmetric,
                std::span<const CouplingState> couplings, const Rounding& rounding);

}  // namespace mortise::post
