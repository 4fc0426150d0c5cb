// Forces on the bodies: what loads, supports, obstacles and neighbours push them with, and whether it adds up.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contact/mortar.hpp"
#include "contact/state.hpp"
#include "feti/dual_problem.hpp"

namespace mortise::post {

/// The resultant of each of the deck's supports on the bodies; contact forces that go straight into them count. Axes of
/// revolution are none of them. Collective.
std::vector<std::array<double, 3>> reactions(const feti::DualProblem& problem, const Vector& lambda, std::size_t supports);

/// Sums of forces; in axisymmetry those along the axis alone, since what pushes a ring outwards needs no support.
struct Balance {
  Point applied = Point::Zero(), supports = Point::Zero();
  Point obstacles = Point::Zero();   ///< rigid ones
  Point neighbours = Point::Zero();  ///< the sectors beside a cyclic one
  Point gauges = Point::Zero();      ///< what holds free motions against the push of facets, which is no force of the model
  double largest = 0;                ///< of loads, supports, contacts
  double difference = 0;             ///< of the sum of all, relative to the largest
  double push_of_facets = 0;         ///< of `gauges`, relative to the largest
};

/// What rounding may leave of forces and energies where nothing is strained, for displacements of each subdomain.
struct Rounding {
  double force = 0, energy = 0;
};
/// Collective.
Rounding rounding(const std::vector<Eigen::VectorXd>& displacement, const std::vector<std::vector<double>>& nodal_stiffness,
                  int dimension, const Communicator& comm);

/// `reactions` and `contacts`: of each support and contact. Collective.
Balance balance(const feti::DualProblem& problem, const Vector& lambda, std::span<const std::array<double, 3>> reactions,
                std::span<const contact::Resultant> contacts, std::span<const contact::Pair> pairs, bool axisymmetric,
                const Rounding& rounding);

}  // namespace mortise::post
