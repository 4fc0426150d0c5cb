#include "model/resolution.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "model/auto_contacts.hpp"
#include "model/patterns.hpp"
#include "side_bodies.hpp"

namespace mortise::model {

namespace {

Temperatures read_temperatures(const Deck& deck, deck::Document& document, const Communicator& comm)
{
  Temperatures result;
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    const auto& change = deck.loads[i].temperature_change;
    if (!change || !change->file) continue;
    try {
      result.emplace(i, std::make_shared<const io::NodalField>(change->file->file, change->file->field, deck.dimension(), comm));
    } catch (const Error& error) {
      document.error(fmt::format("loads[{}].temperature_change.file", i), error.what());
    }
  }
  return result;
}

}  // namespace

Resolution resolve(const Deck& deck, deck::Document& document, partition::Decomposition decomposition, const Context& context)
{
  Resolution result{std::move(decomposition), {}, {}, {}};
  result.contacts = resolve_patterns(deck, document, result.decomposition, context.comm);
  result.temperatures = read_temperatures(deck, document, context.comm);
  check_names(deck, result.contacts, document, result.decomposition.catalogue);
  document.check();
  result.found = resolve_auto(deck, result.contacts, document, result.decomposition, context);
  document.check();
  exchange_stiff_sides(deck, result.contacts, result.decomposition, context.comm);
  return result;
}

}  // namespace mortise::model
