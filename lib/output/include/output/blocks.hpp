// The parts of a model by name, as this rank's part of blocks.pvd.
#pragma once

#include "output/volume.hpp"

namespace mortise::output {

/// Whether blocks.pvd is to be written: as the deck says or, where it leaves that open, if blocks are few and small. `contacts`:
/// how many there are.
bool wants_blocks(const model::Deck& deck, const mesh::Catalogue& catalogue, std::size_t contacts);

/// Blocks of bodies, of contacts, and of the boundaries that supports, loads and couplings name, once each. `sides`: as of
/// contact_sides().
std::vector<io::Block> named_blocks(const model::Deck& deck, const partition::Decomposition& decomposition,
                                    const std::vector<contact::Pair>& pairs, const post::StressField& stress,
                                    const Volume& volume, const io::Piece& sides);

}  // namespace mortise::output
