// Whether displacements of subdomains fit together: what an iterate of the dual problem leaves open.
#pragma once

#include "feti/dual_problem.hpp"
#include "partition/node_directory.hpp"

namespace mortise::post {

/// The largest distance of a held node from where supports hold it, along what each of them prescribes, or from where the motion
/// of its rigid coupling's point takes it; nu are the multipliers that u belongs to. Springs are no such supports. Collective.
double distance_from_supports(const feti::DualProblem& problem, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu);

/// How far parts that are one are from each other: the largest distance of a copy of a node from the mean of its copies, and of a
/// node of a bonded contact from where the other side holds it; nu as above. Collective.
double distance_between_parts(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                              const partition::Interface& interface, const std::vector<Eigen::VectorXd>& u,
                              const Eigen::VectorXd& nu);

/// How far displacements `u` of subdomains, with the multipliers nu, are from those of one assembly: the largest distance of a
/// copy of a node from the mean of its copies, over the largest displacement of its body if that is loaded, else of all; and
/// the largest overlap at a contact node, distance across a bond and distance_from_supports() over the largest displacement. A
/// plate bends by much at little energy, and so do a clip beside a press and soft glue, so that a small error in the energy norm
/// alone says little of them. Collective.
double incompatibility(const feti::DualProblem& problem, const partition::Decomposition& decomposition,
                       const partition::Interface& interface, const std::vector<Eigen::VectorXd>& u, const Eigen::VectorXd& nu);

}  // namespace mortise::post
