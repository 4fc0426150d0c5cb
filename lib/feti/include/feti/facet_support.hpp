// Loads that friction alone would have to hold and cannot: in the solution facets of the mesh hold them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "constraint/sliding_surface.hpp"
#include "feti/dual_problem.hpp"

namespace mortise::feti {

/// A ring on its shaft turns along the surface that they share: pressure does no work on it, and friction alone balances a
/// torque,
///
///     e.v <= sum_i r_i |t_i v|    for every rigid motion v that lets surfaces slide along themselves,
///
/// e.v the work of the loads, t_i the tangential rows of a contact node, r_i the bound of its force. Where normals of the mesh do
/// work on v, a solution may exceed this: the ring turns until facets stop it. Such motions are looked for of each body, of
/// bodies that bonds join, and of bodies that sticking nodes join; what all normals of a contact feel alike (a taper) is no
/// facet. Nor do normals of flat bodies support what is round and turns on them: pressure moves along with the turn until its
/// lever makes up for what friction lacks, as long as displacements are linear. It is no equilibrium either where all that rubs slid along such a motion by a tenth of the bodies' size: friction does
/// not grow with the way, so it holds there by the forces of facets (a ball in its cup turns until tilts of 1e-6 have wedged it)
/// or by turns that are no longer small (a ladder slips until its round ends have shortened its weight's lever).
///
/// `lambda`, `displacement`: a solution; `bounds`: r_i of each disc of problem.set(), forces; `slack`: part of the right
/// side that counts as inexact. Returns `body "ring" rotates about ..` and how much of the load friction holds, or nothing where
/// friction holds all. Collective.
std::optional<std::string> supported_by_facets(const DualProblem& problem, const partition::Decomposition& decomposition,
                                               fem::Kinematics kinematics,
                                               std::span<const constraint::SlidingSurface> sliding_surfaces, const Vector& lambda,
                                               const std::vector<Eigen::VectorXd>& displacement, std::span<const double> bounds,
                                               double slack);

}  // namespace mortise::feti
