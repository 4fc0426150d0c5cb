// How far bodies slide and roll on each other: contact is looked for on the undeformed bodies, whose surfaces are facets.
#pragma once

#include <vector>

#include "base/warning.hpp"
#include "contact/state.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// What a solution says of that, each kind in its order; `states` are the states of contacts.nodes. Bonded and cyclic contacts do
/// neither. Nothing rolls in axisymmetric models. Collective.
///
/// "long_slide": a closed contact node slides by more than the longest distance of two corners of its face; by more than a tenth
/// of that where no more nodes of the contact are closed than a facet has corners (two in planes, three in space). The jump of
/// the displacements along the surface is taken from the normal rows, so that points without friction count as well.
///
/// "facet_turn": a body turns on a contact that presses on less than the width of a face, by more than half a percent of the
/// angle between the faces there, and hardly deforms beside that. The round body of a coarse mesh turns, or rolls, until it
/// stands on a facet, where the body that is meant stays as it is.
///
/// "rolled_contact": a round body rolls in a contact that mostly sticks, several faces wide, over more than a tenth of the
/// width on which it presses. The contact stays where it was, with the directions that the surfaces had, so that the force F
/// across it gets a part F * turn along it, which nothing real would resist. Where it mostly slips, over a twentieth of that
/// width: the pressure comes to lie aside of the body's axis by R * turn, and what holds the body against turning lacks that
/// moment; over a fiftieth, if that is more than a twentieth of what friction has.
std::vector<Warning> slides_and_rolls(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                      std::span<const contact::ContactNodeState> states,
                                      const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                                      const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm);

}  // namespace mortise::post
