#include "model/resolution.hpp"

#include "model/auto_contacts.hpp"
#include "model/patterns.hpp"

namespace mortise::model {

Resolution resolve(const Deck& deck, deck::Document& document, partition::Decomposition decomposition, const Context& context)
{
  Resolution result{std::move(decomposition), {}, {}};
  result.contacts = resolve_patterns(deck, document, result.decomposition, context.comm);
  check_names(deck, result.contacts, document, result.decomposition.catalogue);
  document.check();
  result.found = resolve_auto(deck, result.contacts, document, result.decomposition, context);
  document.check();
  return result;
}

}  // namespace mortise::model
