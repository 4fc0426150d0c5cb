// What small displacements leave out where bodies turn. A body that turns by omega about c is moved by omega x r, r = x - c, and
// not by the second order of a rotation, 1/2 omega x (omega x r), which would take it back towards its axis: it grows. Where
// bodies are held at given distances, contacts press more for it, or less.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/warning.hpp"
#include "contact/mortar.hpp"
#include "feti/dual_problem.hpp"
#include "partition/decomposition.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// What the second order of all turns would change, an estimate of first order: the gap of contact node i lacks
///
///     g_i = row_i . (1/2 omega x (omega x r) + v),
///
/// where v moves each body rigidly so that supports and bonds feel least of it, and contacts that press or stick, by weights of
/// their forces lambda_i: what a force holds gives way. What is round and turns in what is round feels less of it, or nothing:
/// the part that rows feel of the turn across where they press, over what flats would. Of bodies that are loaded by given
/// motions alone, sum lambda_i g_i is what their strain energy lacks.
struct LargeTurn {
  double change = 0;  ///< of forces, relative: sum |lambda_i g_i| over twice the strain energy of the bodies that it concerns
  double sign = 0;    ///< that of the sum without absolute values: -1 where the contacts press too much
  Found largest;      ///< |lambda_i g_i| of a contact node; `body` is its contact
  int body = -1;      ///< that grows by most, its turn times itself times its size
  double angle = 0;   ///< its turn, radians
};

/// `states`: of the contact nodes of this rank; `strain_energy`: of each body, over all ranks. Without products or solutions;
/// where turns are small it costs a sweep over the nodes. None in axisymmetry. Collective.
LargeTurn large_turn(const feti::DualProblem& problem, const Vector& lambda, const partition::Decomposition& decomposition,
                     fem::Kinematics kinematics, const std::vector<Eigen::VectorXd>& displacement,
                     std::span<const contact::Pair> pairs, std::span<const contact::ContactNodeState> states,
                     std::span<const double> strain_energy);

/// "large_turn": it changes forces by more than 2 %.
std::vector<Warning> large_turns(const LargeTurn& turn, std::span<const contact::Pair> pairs,
                                 const std::vector<std::string>& names);

}  // namespace mortise::post
