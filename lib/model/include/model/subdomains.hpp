// The deck's bodies as subdomains.
#pragma once

#include "base/context.hpp"
#include "model/deck.hpp"
#include "partition/decomposition.hpp"

namespace mortise::model {

/// Reads or generates the deck's mesh and cuts its bodies into subdomains: whole ones where a direct solution is asked for, and
/// of bodies of boundary elements the surface, with their cells where the deck asks for values inside. Throws Error(bad_input) as
/// partition::decompose and partition::skins. Collective.
partition::Decomposition make_subdomains(const Deck& deck, const Context& context);

}  // namespace mortise::model
