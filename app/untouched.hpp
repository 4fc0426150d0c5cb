// Bodies that no support holds and no contact reaches, told before anything is solved.
#pragma once

#include "warnings.hpp"

namespace mortise {

/// Names every such body, the body nearest to it and the distance. Throws Error(no_equilibrium) if the loads of `state` drive one
/// of them, which nothing would stop; warns of the others, whose rigid motions the solver sets to zero. Collective.
void judge_untouched(const Deck& deck, const partition::Decomposition& decomposition, const Model& model, const LoadState& state,
                     const std::vector<contact::Pair>& pairs, const constraint::Contacts& contacts, const Context& context,
                     Warnings& found);

}  // namespace mortise
