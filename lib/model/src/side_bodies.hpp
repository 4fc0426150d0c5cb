// Which bodies are on the two sides of contacts, how stiff they are, and which side carries the multipliers.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "model/deck.hpp"
#include "partition/decomposition.hpp"

namespace mortise::model {

/// Of each side the bodies it lies on: 2 c is the secondary side of contact c, 2 c + 1 the primary one. Contacts with obstacles,
/// with the next sector, and those that `auto` stands for are left out, as are sides without faces. Collective.
std::map<int, std::set<int>> bodies_on_sides(const std::vector<contact::Options>& contacts,
                                             const partition::Decomposition& decomposition, const Communicator& comm);

/// The smallest Young's modulus of a body's materials.
double least_modulus(const Deck& deck, const mesh::Body& body);

/// Exchanges the sides of contacts (Options::exchanged) whose secondary side is far stiffer than the primary one and has smaller
/// faces: the soft side's nodes cannot follow all of its own, so that the multipliers are not unique, and press at single nodes.
/// Of bonds whatever the faces: soft ones bulge between the nodes of a stiff side. Pretension sections and `node_to_segment` stay
/// as they are. Collective.
void exchange_stiff_sides(const Deck& deck, Contacts& contacts, const partition::Decomposition& decomposition,
                          const Communicator& comm);

}  // namespace mortise::model
