// The parts of a model by name, as this rank's part of blocks.pvd.
#pragma once

#include "output/volume.hpp"

namespace mortise::output {

/// Whether the deck asks for them; where it leaves that open, if they are few and small enough.
bool wants_blocks(const model::Deck& deck, const mesh::Catalogue& catalogue, std::size_t contacts);

/// Bodies, contacts, and the boundaries that supports, loads and couplings name, once each. `sides`: see contact_sides().
std::vector<io::Block> named_blocks(const model::Deck& deck, const partition::Decomposition& decomposition,
                                    const std::vector<contact::Pair>& pairs, const post::Results& results, const Volume& volume,
                                    const io::Piece& sides);

}  // namespace mortise::output
