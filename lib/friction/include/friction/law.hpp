// Laws of friction, in one table (law.cpp): the slip bounds of contact nodes.
#pragma once

#include <string_view>
#include <vector>

#include "feti/dual_problem.hpp"

namespace mortise::friction {

/// The law of one contact. To add a law: a value here and its row in the table.
struct Law {
  enum class Kind { frictionless, tresca, coulomb } kind = Kind::frictionless;
  double value = 0;  ///< tresca: traction, force per area; coulomb: coefficient, a number
};

/// The law with this name in the deck; of a name without a row, as that of bonded contacts, the one without friction. `value`:
/// see Law.
Law law_of(std::string_view name, double value);

/// The slip bound of each disc of problem.set(), a force, from the multipliers `lambda`; without lambda Coulomb points stick,
/// with an infinite one. laws[c]: of contact c.
std::vector<double> slip_bounds(const feti::DualProblem& problem, const std::vector<Law>& laws, const Vector* lambda);

/// Whether the slip bounds of any contact follow its forces.
bool any_coulomb(const std::vector<Law>& laws);

/// system.set() with the coefficient of each disc under Coulomb's law, see qp::Disc; 0 under others. Slip bounds are to come.
qp::FeasibleSet with_coefficients(const feti::DualSystem& system, const std::vector<Law>& laws);

/// ||next - now|| / ||next|| of slip bounds as radii of discs, the largest of any group of bodies (feti::BodyGroups), those that
/// are infinite in either left out; `least` is the size below which they are rounding. Collective.
double relative_change(const feti::DualProblem& problem, const std::vector<double>& next, const std::vector<double>& now,
                       double least);

}  // namespace mortise::friction
